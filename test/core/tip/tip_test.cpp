#include "afm/tip.h"

#include <gtest/gtest.h>

#include <cmath>
#include <utility>

#include "afm/surface.h"
#include "core/run/interruptible_advance.h"
#include "support/models.h"

namespace afm {
namespace {

Model model_at(double eta) { return model_with_cutoff(0.1 * std::abs(eta)); }

Tip tip_at(double eta) { return {model_at(eta), eta, start_at(eta)}; }

bool is_event(Outcome outcome) { return outcome != Outcome::time_limit && outcome != Outcome::flying; }

TEST(Tip, TimeNeverRunsBackwards) {
  Tip tip = tip_at(2.75);
  tip.advance({0, 0.1});
  const ModelTime now = tip.now();
  EXPECT_EQ(tip.advance({0, 0.05}), Outcome::time_limit);
  EXPECT_TRUE(tip.now() == now);
}

TEST(Tip, TheDeflectionIsThatOfTheState) {
  int in_chatter = 0;
  for (const double eta : {3.4, 0.1}) {
    Tip tip = tip_at(eta);
    const Model model = model_at(eta);
    for (int i = 1; i < 1000; ++i) {
      const ModelTime t = multiply(static_cast<std::uint64_t>(i), 0.0171);
      detail::bring_to(tip, t);
      const FreeState state = tip.state();
      const Deflection deflection = tip.deflection(t);
      // the samples of a step in contact are good to its tolerance
      const double error = tip.in_contact() ? 2e-4 * kDefaultContactTolerance : 1e-14;
      ASSERT_NEAR(deflection.vertical, state.y - model.y0, error);
      ASSERT_NEAR(deflection.lateral, state.X, error);
      ASSERT_NEAR(deflection.gap, state.y - surface_jet(model.H, state.phase).h, error);
      in_chatter += tip.in_chatter();
    }
  }
  EXPECT_GT(in_chatter, 20);
}

TEST(Tip, ThePresentDragVelocityAgainChangesNoBit) {
  for (const double eta : {0.2, 3.4}) {
    Tip whole = tip_at(eta), split = whole;
    for (int i = 0; i < 1000; ++i) {
      const Outcome outcome = whole.advance({100000, 0.0});
      const ModelTime command = split.now() + 0.3 * (whole.now() - split.now());
      if (command < whole.now()) {
        split.advance(command);
        split.drag(eta);
      }
      ASSERT_EQ(split.advance(whole.now()), outcome);
      const TipState a = whole.tip_state(), b = split.tip_state();
      ASSERT_TRUE(split.now() == whole.now() && a.phase == b.phase && a.X == b.X && a.u == b.u && a.g1 == b.g1);
    }
  }
}

TEST(Tip, DraggedTheOtherWayItIsItsMirrorImage) {
  // where small differences die out; the last with chatter and contact
  for (const auto& [eta, v_c] : {std::pair(2.0, 0.2), {2.25, 0.225}, {4.5, 0.45}, {0.2, 0.01}}) {
    const Model model = model_with_cutoff(v_c);
    Tip right(model, eta, FreeState{0.25, 0.01, 0.2, eta, 0.3});
    Tip left(model, -eta, FreeState{0.75, -0.01, 0.2, -eta, 0.3});
    for (int i = 0; i < 3000; ++i) {
      ASSERT_EQ(right.advance(kEndOfTime), left.advance(kEndOfTime));
      const Impact &r = right.last_impact(), &l = left.last_impact();
      ASSERT_NEAR(right.now() - left.now(), 0.0, 1e-9) << eta << " impact " << i;
      ASSERT_NEAR(r.surface_phase, wrap_phase(-l.surface_phase), 1e-9) << eta << " impact " << i;
      ASSERT_NEAR(r.normal_speed, l.normal_speed, 1e-8) << eta << " impact " << i;
      ASSERT_NEAR(r.tangential_velocity, -l.tangential_velocity, 1e-8) << eta << " impact " << i;
    }
  }
}

TEST(Tip, AnEventIsWhatTheStatesOnEitherSideSay) {
  for (const double eta : {3.4, 0.5}) {
    Tip tip(model_with_cutoff(eta > 1.0 ? 0.34 : 0.01), eta, start_at(eta));
    for (int i = 0; i < 3000; ++i) {
      ASSERT_TRUE(is_event(tip.advance(kEndOfTime)));
      const Impact& event = tip.last_impact();
      const TipState after = tip.tip_state();
      ASSERT_TRUE(event.time == tip.now());
      const double slope = surface_jet(tip.model().H, after.phase).h1, n = std::sqrt(1.0 + slope * slope);
      const double w = after.g1 + slope * after.u;
      ASSERT_NEAR((after.u + slope * w) / n, event.tangential_velocity, 1e-13);
      ASSERT_EQ(after.g, 0.0);
      if (event.kind != ImpactKind::impact || tip.in_chatter()) continue;
      ASSERT_EQ(event.surface_phase, after.phase);
      ASSERT_GT(event.normal_speed, 0.0);
      ASSERT_GE(event.energy_loss, 0.0);
      ASSERT_GT(after.g1, 0.0);
    }
  }
}

// x = v0 t, y = h(x) solves the motion at eta = 1: nothing presses, nothing pulls, and nothing may happen.
TEST(Tip, OnTheGlideNothingHappens) {
  for (const double eta : {1.0, -1.0}) {
    for (const double phase : {0.0, 0.25, 0.6, 0.75}) {
      for (const double tolerance : {0.0, kDefaultContactTolerance}) {
        Tip tip(Model{}, eta, TipState{phase, 0.0, eta, 0.0, 0.0}, tolerance);
        ASSERT_EQ(tip.advance({1000, 0.0}), Outcome::contact);
        ASSERT_EQ(tip.advance({1000, 0.0}), Outcome::time_limit) << phase;
        EXPECT_NEAR(tip.tip_state().X, 0.0, 1e-9);
        EXPECT_NEAR(tip.tip_state().u, eta, 1e-8);
      }
    }
  }
}

// The same from starts in the lab, whose gap rate is rounded. Once it bounced by that for ever, in 20,000 steps of the
// search each time.
TEST(Tip, OnTheGlideRoundingIsNoBounce) {
  for (const auto kind : {ModelKind::oscillator, ModelKind::hammer}) {
    Model model;
    model.kind = kind;
    for (int i = 0; i < 100; ++i) {
      const double eta = i % 2 == 0 ? 1.0 : -1.0, phase = 0.0073 + 0.00971 * i;
      const SurfaceJet surface = surface_jet(model.H, phase);
      Tip tip(model, eta, FreeState{phase, 0.0, surface.h, eta, surface.h1 * eta});
      int events = 0;
      while (tip.advance({2, 0.0}) != Outcome::time_limit) ++events;
      EXPECT_LE(events, 2) << phase;
      EXPECT_TRUE(tip.in_contact()) << phase;
    }
  }
}

// Each bounce keeps a hundredth of the speed: seventy of them, and the squares of what is left are no numbers any more.
TEST(Tip, BouncesByThemselvesDieOutIntoContact) {
  Model model;
  model.gamma = 0.01;
  model.v_c = 0.0;
  for (const auto kind : {ModelKind::oscillator, ModelKind::hammer}) {
    model.kind = kind;
    Tip tip(model, 0.0, FreeState{0.1, 0.0, 0.2, 0.0, 0.0}, 0.0);
    double slowest = 1.0;
    Outcome outcome = tip.advance({2, 0.0});
    for (; outcome == Outcome::impact; outcome = tip.advance({2, 0.0})) slowest = tip.last_impact().normal_speed;
    EXPECT_EQ(outcome, Outcome::contact) << name(kind);
    EXPECT_LT(slowest, 1e-15) << name(kind);
    while (outcome != Outcome::time_limit) {
      outcome = tip.advance({2, 0.0});
      ASSERT_NE(outcome, Outcome::search_failed) << name(kind);
    }
  }
}

// On the steepest of the slope springs and surface are in balance at eta = 0, and at 1e-18 all but: what presses is the
// third derivative, and bounces of 1e-57 a/tau ended where rounding said, as fast as they began however small gamma.
TEST(Tip, WhereHardlyAForceIsLeftItComesToRest) {
  Model model;
  model.v_c = 0.0;
  const double eta = 1.0000013124039413e-18, tolerance = kDefaultContactTolerance;
  for (const double gamma : {5.9371814145560333e-08, 7.6353317144409129e-05, 0.01, 0.3, 0.45}) {
    model.gamma = gamma;
    Tip tip(model, eta, TipState{0.75, 0.0, eta, 0.0, 2.11806e-43}, tolerance);
    Outcome outcome = tip.advance({10, 0.0});
    int bounces = 0;
    for (; outcome == Outcome::impact && bounces < 100; ++bounces) outcome = tip.advance({10, 0.0});
    EXPECT_EQ(outcome, Outcome::contact) << gamma;
    EXPECT_EQ(tip.advance({10, 0.0}), Outcome::time_limit) << gamma;
  }
}

// A commanded velocity may halve until it is next to nothing: it throws a riding hammer off by as little.
TEST(Tip, AHammerIsThrownOffByNextToNothing) {
  Model model;
  model.kind = ModelKind::hammer;
  for (const double eta : {1e-150, -1e-150, 1e-200, -1e-200, 1e-300, 5e-324}) {
    Tip tip(model, 0.0, TipState{0.1, 0.0, 0.0, 0.0, 0.0});
    ASSERT_EQ(tip.advance({1, 0.0}), Outcome::contact);
    ASSERT_EQ(tip.advance({1, 0.0}), Outcome::time_limit);
    tip.drag(eta);
    for (Outcome outcome = Outcome::flying; outcome != Outcome::time_limit;) {
      outcome = tip.advance({2, 0.0});
      ASSERT_NE(outcome, Outcome::search_failed) << eta;
    }
    EXPECT_TRUE(tip.in_contact()) << eta;
  }
}

TEST(Tip, AtRestItStaysAtRestCostsNothingAndWakesUp) {
  Tip tip(Model(), 0.0, TipState{0.0, 0.0, 0.0, 0.0, 0.0});
  long segments = 0;
  while (tip.advance_segment({100000, 0.0}) != Outcome::time_limit) ++segments;
  EXPECT_TRUE(tip.in_contact());
  EXPECT_LE(segments, 100000 / 7);
  const FreeState rest = tip.state();
  EXPECT_EQ(rest.phase, 0.0);
  EXPECT_EQ(rest.X, 0.0);
  EXPECT_EQ(rest.u, 0.0);
  tip.drag(3.0);
  int impacts = 0;
  while (tip.advance({100100, 0.0}) != Outcome::time_limit) ++impacts;
  EXPECT_GT(impacts, 100);
}

TEST(Tip, RefusesAStartBelowTheSurface) {
  EXPECT_THROW(Tip(Model(), 1.0, FreeState{0.0, 0.0, 0.0, 1.0, 0.0}), ParameterError);
  EXPECT_NO_THROW(Tip(Model(), 1.0, FreeState{0.5, 0.0, 0.0, 1.0, 0.0}));
}

TEST(Tip, RefusesAFaultyModel) { EXPECT_THROW(Tip(model_with(-1.0, 0.05), 1.0, start_at(1.0)), ParameterError); }

}  // namespace
}  // namespace afm
