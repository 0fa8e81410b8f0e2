// Kicks wherever the tip is: in the air, in a chatter sequence, in contact, at rest.
#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <utility>

#include "afm/detail/chatter.h"
#include "afm/surface.h"
#include "afm/tip.h"
#include "support/models.h"

namespace afm {
namespace {

Tip tip_of(double gamma, double v_c, double eta, double rest_height = 0.0) {
  Model model = model_with(gamma, v_c);
  model.y0 = rest_height;
  return Tip(model, eta, start_at(eta));
}

// On the surface, on a slope.
Tip tip_at_rest() {
  Tip tip(Model{}, 0.0, TipState{0.1, 0.0, 0.0, 0.0, 0.0});
  EXPECT_EQ(tip.advance({}), Outcome::contact);
  return tip;
}

// At eta = 0.3 chatter, contact and flights follow each other.
TEST(Kick, ComesInTheAirInChatterAndInContact) {
  Tip tip = tip_of(0.7, 0.01, 0.3);
  tip.set_bath(bath_of(1e-3, 50.0));
  std::set<SegmentKind> split;
  Segments ended;
  while (tip.now() < ModelTime{3000, 0.0}) {
    tip.advance_segment({3000, 0.0}, &ended);
    const Segment* last = ended.end() - 1;
    if (last > ended.begin() && last->kind == SegmentKind::kick) split.insert((last - 1)->kind);
  }
  EXPECT_EQ(split, (std::set<SegmentKind>{SegmentKind::flight, SegmentKind::chatter, SegmentKind::contact}));
}

TEST(Kick, IntoTheSurfaceIsAnImpactAtOnceAndAwayFromItLeaves) {
  int leaves = 0, hits = 0;
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    Tip tip = tip_at_rest();
    Bath bath = bath_of(0.3, 50.0);
    bath.seed = seed;
    tip.set_bath(bath);
    const ModelTime kick = tip.now() + 0.5;
    ASSERT_EQ(tip.advance({10000, 0.0}), Outcome::released);
    EXPECT_EQ(tip.now(), kick);
    EXPECT_EQ(tip.last_impact().kind, ImpactKind::contact_ended);
    const double gap_rate = tip.tip_state().g1;
    ASSERT_NE(gap_rate, 0.0);
    if (gap_rate > 0.0) {
      ++leaves;
      tip.advance(kick);
      EXPECT_FALSE(tip.in_contact());
    } else {
      ++hits;
      ASSERT_EQ(tip.advance(kick), Outcome::impact);
      EXPECT_EQ(tip.now(), kick);
      EXPECT_GT(tip.last_impact().energy_loss, 0.0);
    }
  }
  EXPECT_GT(leaves, 5);
  EXPECT_GT(hits, 5);
}

// 1 nN on the paper's lever presses the tip down: the bounces after a kick last a thousandth of a tau.
TEST(Kick, UnderALoadItsBouncesAreOneEventAndContactGoesOn) {
  Tip tip = tip_of(0.7, 0.05, 0.3, -3.0);
  tip.set_bath(bath_of(0.926, 100.0, 29.034));
  while (tip.now() < ModelTime{100, 0.0}) tip.advance({100, 0.0});
  int collapses = 0;
  double brought = 0.0, lost = 0.0;
  for (int kick = 0; kick < 200; ++kick) {
    const ModelTime time = tip.thermostat().next();
    const bool contact = tip.in_contact();
    const Outcome outcome = tip.advance(time);
    if (!contact || outcome != Outcome::impact || !tip.in_contact()) continue;
    ++collapses;
    const Impact& bounces = tip.last_impact();
    EXPECT_EQ(bounces.kind, ImpactKind::burst);
    EXPECT_GT(bounces.count, 1u);
    brought += 0.5 * bounces.normal_speed * bounces.normal_speed;
    lost += bounces.energy_loss;
  }
  EXPECT_GT(collapses, 100);
  EXPECT_NEAR(lost, brought, 0.01 * brought);  // the rest is that of the displacement
}

// Each bounce of a constant loss leaves the part gamma of the speed, down to the threshold of contact.
TEST(Kick, IntoTheSurfaceOneEventCountsItsFirstImpactToo) {
  constexpr double kGamma = 0.5;
  Tip tip = tip_of(kGamma, 0.0, 0.3, -3.0);
  tip.set_bath(bath_of(0.926, 100.0, 29.034));
  int collapses = 0;
  for (Outcome outcome = Outcome::flying; outcome != Outcome::time_limit;) {
    const bool contact = tip.in_contact();
    outcome = tip.advance({30, 0.0});
    if (!contact || outcome != Outcome::impact || !tip.in_contact()) continue;
    ++collapses;
    const Impact& all = tip.last_impact();
    const double bounces = std::log2(all.normal_speed / detail::chatter_threshold(kDefaultContactTolerance));
    EXPECT_NEAR(all.count, bounces - 0.5, 0.5 + 1e-9);  // rounded down
  }
  EXPECT_GT(collapses, 100);
}

// A lever of omega_h = 21 omega_v under a small load flies off now and then.
TEST(Kick, UnderALoadAFlightEndsInContactAtOnce) {
  Model model;
  model.frequency_ratio = 21.0;
  model.y0 = -3.0;
  Tip tip(model, 0.3, lowered_tip(model.H));
  tip.set_bath(bath_of(3.0, 100.0, 13.0));
  int at_once = 0;
  while (tip.now() < ModelTime{1000, 0.0}) {
    const bool flying = tip.in_flight();
    if (tip.advance({1000, 0.0}) != Outcome::impact || !flying || tip.in_flight()) continue;
    const Impact landing = tip.last_impact();
    if (landing.kind != ImpactKind::burst || tip.in_chatter()) continue;
    ++at_once;
    ASSERT_GT(landing.count, 1u);
    ASSERT_GT(landing.energy_loss, 0.0);
    ASSERT_EQ(tip.advance({1000, 0.0}), Outcome::contact);
    ASSERT_EQ(tip.now(), landing.time);
  }
  EXPECT_GT(at_once, 100);
}

// Without chance nothing hides an error: an impact is an impact.
TEST(Kick, WithoutTemperatureEveryBounceAfterAFlightIsMade) {
  Tip damped = tip_of(0.7, 0.05, 0.3, -3.0);
  damped.set_bath(bath_of(0.0, 100.0, 13.0));
  Outcome outcome = Outcome::flying;
  while (outcome != Outcome::contact && outcome != Outcome::time_limit) {
    const bool chatter = damped.in_chatter();
    outcome = damped.advance({100, 0.0});
    if (outcome == Outcome::impact) {
      ASSERT_EQ(damped.last_impact().kind == ImpactKind::burst, chatter);
    }
  }
  EXPECT_EQ(outcome, Outcome::contact);
}

// The bounces of a constant loss end by themselves.
TEST(Kick, OneEventDisplacesTheTipAsItsBouncesDo) {
  constexpr double kEta = 0.3, kSpeed = 0.01, kContact = 1e-5;
  Model model = model_with(0.7, 0.0);
  model.y0 = -1.0;
  const SpringConstants<double> m(model);
  for (const double phase : {0.1, 0.15, 0.3, 0.6, 0.85}) {
    const detail::SlideState<double> at{phase, 0.0, 2.0};
    Tip bounced(model, kEta, leave_surface(model, at, kSpeed), 0.0);
    int count = 0;
    while (bounced.advance({1, 0.0}) != Outcome::contact) {
      ASSERT_LT(bounced.now(), (ModelTime{1, 0.0}));
      count += detail::project_onto_surface(model, bounced.tip_state()).normal_speed > kContact ? 1 : 0;
    }
    const double time = bounced.now() - ModelTime{};
    const auto bounces = detail::ChatterLaw(model, kDefaultContactTolerance).collapsed(m, kEta, at, kSpeed, 1.0, 1.0);
    ASSERT_TRUE(bounces);
    EXPECT_NEAR(bounces->n, count, 1.0) << phase;
    const detail::SlideSegment<double> kept_slide(m, kEta, at);
    const detail::SlideSegment<double> displaced_slide(m, kEta, displaced_reference(model, at, *bounces));
    const detail::SlideState<double> kept = kept_slide.at(time), displaced = displaced_slide.at(time);
    EXPECT_NEAR(bounced.tip_state().u, displaced.u, 0.2 * std::abs(displaced.u - kept.u)) << phase;
    EXPECT_NEAR(bounced.tip_state().phase, displaced.phase, 0.2 * std::abs(displaced.phase - kept.phase)) << phase;
  }
}

TEST(Kick, OneEventCountsTheBouncesUpToTheNextKick) {
  constexpr double kEta = 0.3, kSpeed = 0.01;
  Model model = model_with(0.7, 0.05);
  model.y0 = -1.0;
  const SpringConstants<double> m(model);
  const detail::ChatterLaw law(model, kDefaultContactTolerance);
  for (const double phase : {0.1, 0.15, 0.3, 0.6, 0.85}) {
    const detail::SlideState<double> at{phase, 0.0, 0.5};
    for (const double time : {0.025, 0.03, 0.5}) {
      const auto bounces = law.collapsed(m, kEta, at, kSpeed, 1.0, time);
      ASSERT_TRUE(bounces);
      const detail::ChatterRun made = law.run(detail::SlideSegment<double>(m, kEta, at), time, {kSpeed, 0.0});
      EXPECT_EQ(made.end, time < 0.1 ? detail::ChatterEnd::time : detail::ChatterEnd::died);
      EXPECT_NEAR(bounces->n, made.chatter.n, 0.3 * made.chatter.n) << phase << ' ' << time;
    }
  }
}

TEST(Kick, OnAnElasticSurfaceEveryBounceIsMade) {
  Tip tip = tip_of(1.0, 0.05, 0.0, -3.0);
  tip.set_bath(bath_of(0.3, 100.0, 29.034));
  while (tip.now() < ModelTime{200, 0.0}) {
    tip.advance({200, 0.0});
    ASSERT_EQ(tip.last_impact().kind, ImpactKind::impact);
  }
}

// K_f by the work of the drag, of a tip that a load holds on the surface.
double damped_friction(ModelKind kind, double eta, double Q, double kicks_per_tau, double y0 = -0.5) {
  Model model;
  model.kind = kind;
  model.y0 = y0;
  Tip tip(model, eta, lowered_tip(model.H));
  tip.set_bath(bath_of(0.0, Q, kicks_per_tau));
  double ended_work = 0.0;
  const auto work_until = [&](const ModelTime& time) {
    Segments ended;
    while (tip.advance_segment(time, &ended) != Outcome::time_limit) {
      for (const Segment& segment : ended) ended_work += segment.work();
    }
    return ended_work + tip.segment().work();
  };
  const ModelTime begin{300, 0.0}, end{600, 0.0};  // whole cells at the drag velocities below
  const double before = work_until(begin);
  return (work_until(end) - before) / (eta * eta * (end - begin));
}

// The slower the drag, or the more kicks there are, the weaker is each: none is too weak to act.
TEST(Kick, InContactTheDampingIsWhatTheQualityFactorSaysAtAnyRateOfKicks) {
  for (const auto& [eta, Q] : {std::pair(0.2, 100.0), std::pair(0.05, 1000.0)}) {
    const double slope = kTwoPi * Model{}.H * std::sqrt(0.5), expected = kTwoPi / Q * slope * slope;
    for (const double kicks : {29.034, 123.7, 843.618}) {
      EXPECT_NEAR(damped_friction(ModelKind::hammer, eta, Q, kicks) / expected, 1.0, 3e-3) << eta << ' ' << kicks;
      EXPECT_NEAR(damped_friction(ModelKind::oscillator, eta, Q, kicks) / expected, 1.04, 0.02) << eta << ' ' << kicks;
    }
  }
}

// The surface pushes it to and fro by 2 pi H |y0| (omega_v/omega_h)^2. At 1 nN on mica that is most of the friction.
TEST(Kick, InContactTheSwingOfTheLateralSpringIsDampedToo) {
  constexpr double kEta = 0.5, kQ = 100.0, kKicks = 29.034;
  const double slope = kTwoPi * Model{}.H * std::sqrt(0.5), ratio = Model{}.frequency_ratio;
  for (const double y0 : {-0.3, -1.0, -2.0}) {
    const double swing = kTwoPi * y0 * kTwoPi * y0 / (ratio * ratio * ratio);
    EXPECT_NEAR(damped_friction(ModelKind::oscillator, kEta, kQ, kKicks, y0),
                kTwoPi / kQ * slope * slope * (1.0 + swing), 0.04 * kTwoPi / kQ * slope * slope * (1.0 + swing))
        << y0;
  }
}

// Energy lost in impacts and work of the drag, each per tau.
std::pair<double, double> loss_and_work(ModelKind kind, double contact_tolerance) {
  constexpr double kEta = 1.0;
  Model model = model_with(0.7, 0.05, kind);
  model.y0 = -0.1;
  Tip tip(model, kEta, lowered_tip(model.H), contact_tolerance);
  tip.set_bath(bath_of(0.0, 20.0, 29.034));
  const ModelTime end{300, 0.0};
  double loss = 0.0, work = 0.0;
  Segments ended;
  while (tip.advance_segment(end, &ended) != Outcome::time_limit) {
    for (const Segment& segment : ended) loss += segment.loss, work += segment.work();
  }
  return {loss / 300.0, work / 300.0};
}

// It was launched anew by every kick: it lost twice as much in impacts, and K_f by work was 2 % too large.
TEST(Kick, MeetsATipThatChattersWithinItsBounce) {
  for (const ModelKind kind : {ModelKind::oscillator, ModelKind::hammer}) {
    const auto [loss, work] = loss_and_work(kind, kDefaultContactTolerance);
    const auto [every_loss, every_work] = loss_and_work(kind, 1e-6);
    EXPECT_NEAR(loss / every_loss, 1.0, 0.02);
    EXPECT_NEAR(work / every_work, 1.0, 1e-3);
  }
}

// Its rounding, which is not below zero, added up: 6 % of all that was lost on an elastic surface.
TEST(Kick, InTheFirstBounceOfASequenceNothingIsLost) {
  for (const double gamma : {1.0, 0.999}) {
    Model model = model_with(gamma, 0.05);
    model.y0 = -0.1;
    Tip tip(model, 1.0, lowered_tip(model.H));
    tip.set_bath(bath_of(1e-4, 20.0, 29.034));
    double events = 0.0, records = 0.0;
    Segments ended;
    for (Outcome outcome = Outcome::flying; outcome != Outcome::time_limit;) {
      outcome = tip.advance_segment({200, 0.0}, &ended);
      for (const Segment& segment : ended) records += segment.loss;
      if (outcome == Outcome::impact) events += tip.last_impact().energy_loss;
    }
    EXPECT_NEAR(records, events, 1e-13 * events) << gamma;
  }
}

TEST(Kick, WithoutTemperatureATipAtRestStaysAtRest) {
  Tip tip = tip_at_rest();
  tip.set_bath(bath_of(0.0, 20.0));
  while (tip.advance({3000, 0.0}) != Outcome::time_limit) continue;
  ASSERT_TRUE(tip.in_contact());
  const std::int64_t contact = tip.last_impact().time.tau;
  while (tip.advance({20000, 0.0}) != Outcome::time_limit) continue;
  EXPECT_EQ(tip.last_impact().time.tau, contact);  // no event since
  EXPECT_LT(std::abs(tip.state().u), 1e-10);
}

}  // namespace
}  // namespace afm
