// The records of segments: each is in balance, they follow on, and their sums are what the events say.
#include "afm/segment.h"

#include <gtest/gtest.h>

#include <cmath>
#include <ostream>

#include "support/models.h"
#include "support/recorded_run.h"
#include "trials/energy_balance.h"
#include "trials/random_launches.h"

namespace afm {
namespace {

struct Scene {
  ModelKind kind;
  double eta, v_c, quality_factor = 0.0, temperature = 0.0, rest_height = 0.0, gamma = 0.7;
};

void PrintTo(const Scene& s, std::ostream* out) {
  *out << name(s.kind) << ", eta " << s.eta << ", v_c " << s.v_c << ", Q " << s.quality_factor << ", T "
       << s.temperature << ", y0 " << s.rest_height << ", gamma " << s.gamma;
}

class SegmentsOf : public testing::TestWithParam<Scene> {
 protected:
  static Tip tip() {
    const Scene& s = GetParam();
    Model model = model_with(s.gamma, s.v_c, s.kind);
    model.y0 = s.rest_height;
    Tip tip(model, s.eta, start_at(s.eta));
    tip.set_bath(bath_of(s.temperature, s.quality_factor));
    return tip;
  }
  // Without a bath.
  static bool chatters() {
    const Scene& s = GetParam();
    return s.quality_factor == 0.0 && (s.v_c < 0.02 || (s.kind == ModelKind::hammer && std::abs(s.eta) < 1.0));
  }
};

double scale_of(const Tip& tip) { return tip.stored_energy() + 0.5 * tip.eta() * tip.eta() + 1.0; }

// Under a load the rounding is that of the steps in contact.
double rounding_of(const Tip& tip) { return (tip.model().y0 < 0.0 ? 1e-13 : 3e-14) * scale_of(tip); }

// A kick before the first bounce has ended: the speed that the law gave it was off in the eighth digit.
TEST(Segments, OfAHammerAtRestAreInBalance) {
  Model model = model_with(0.3, 0.0, ModelKind::hammer);
  model.y0 = -1.0, model.H = 0.9;
  Tip tip(model, 0.0, FreeState{0.25, 0.0, 0.2, 0.0, 0.0}, 1e-2);
  tip.set_bath(bath_of(0.1, 2.0));
  Segments ended;
  while (tip.advance_segment({2000, 0.0}, &ended) != Outcome::time_limit) {
    for (const Segment& s : ended) ASSERT_NEAR(s.imbalance(), 0.0, rounding_of(tip));
  }
}

TEST_P(SegmentsOf, EachIsInBalanceAndFollowsTheOneBefore) {
  Tip tip = SegmentsOf::tip();
  const double before = tip.stored_energy();
  Segments ended;
  ModelTime last = tip.now();
  long double stored = 0.0L, turned = 0.0L;
  int kinds[5] = {};
  for (int segments = 0; segments < 100000 && tip.now() < ModelTime{50000, 0.0}; ++segments) {
    const Outcome outcome = tip.advance_segment({50000, 0.0}, &ended);
    ASSERT_NE(outcome, Outcome::search_failed);
    for (const Segment& s : ended) {
      ASSERT_EQ(s.begin, last) << segments;
      last = s.end;
      ASSERT_LE(std::abs(s.imbalance()), rounding_of(tip) + 1e-12 * std::abs(s.loss)) << segments;
      ASSERT_EQ(s.eta, GetParam().eta);
      ++kinds[static_cast<int>(s.kind)];
      stored += s.stored, turned += std::abs(s.work()) + s.loss + std::abs(s.heat);
    }
  }
  const double now = tip.stored_energy(), by_records = before + static_cast<double>(stored) + tip.segment().stored;
  EXPECT_NEAR(by_records, now, 1e-12 * (before + static_cast<double>(turned)));
  if (!tip.in_chatter()) {  // else the state is that of the reference slide
    EXPECT_NEAR(stored_energy(tip.model(), tip.state()), now, 1e-13 * scale_of(tip));
  }
  EXPECT_GT(kinds[0], 0);
  EXPECT_GT(kinds[1], 0);
  EXPECT_EQ(kinds[4] > 0, GetParam().quality_factor > 0.0);
  if (chatters()) {
    EXPECT_GT(kinds[2], 10);
    EXPECT_GT(kinds[3], 10);
  }
}

// Limits of any kind: before the end of the segment, in the past, and exactly at it.
TEST_P(SegmentsOf, LimitsChangeNoBit) {
  Tip whole = tip(), halting = tip();
  RandomLaunches random(2);
  Segments a, b;
  for (int segments = 0; segments < 3000; ++segments) {
    const Outcome outcome = whole.advance_segment({1000000, 0.0}, &a);
    Outcome halted = Outcome::time_limit;
    for (int i = 0; halted == Outcome::time_limit; ++i) {
      const ModelTime limit = i % 5 == 4 ? whole.now() : halting.now() + random.within(-0.1, 0.5);
      halted = halting.advance_segment(limit, &b);
      ASSERT_TRUE(halted != Outcome::time_limit || b.begin() == b.end()) << segments;
    }
    ASSERT_EQ(halted, outcome) << segments;
    ASSERT_EQ(halting.now(), whole.now()) << segments;
    ASSERT_TRUE(same_bits(halting.last_impact(), whole.last_impact())) << segments;
    ASSERT_EQ(a.end() - a.begin(), b.end() - b.begin());
    for (const Segment *s = a.begin(), *t = b.begin(); s != a.end(); ++s, ++t) {
      ASSERT_EQ(s->impulse, t->impulse);
      ASSERT_EQ(s->loss, t->loss);
      ASSERT_EQ(s->heat, t->heat);
      ASSERT_EQ(s->stored, t->stored);
      ASSERT_EQ(s->end, t->end);
    }
  }
}

// Also where commands split chatter sequences: nothing is lost or counted twice.
TEST_P(SegmentsOf, LossesAndCountsAddUpToThoseOfTheEventsWhateverTheCommands) {
  Tip tip = SegmentsOf::tip();
  RandomLaunches random(3);
  Segments ended;
  long double events = 0.0L, segments = 0.0L;
  std::uint64_t impacts = 0, counted = 0;
  int split = 0;
  const auto add = [&](const Segment& s) {
    segments += s.loss;
    counted += s.count;
    EXPECT_LE(std::abs(s.imbalance()), rounding_of(tip) + 1e-12 * s.loss);
  };
  for (int commands = 0; commands < 20000; ++commands) {
    const ModelTime next = tip.now() + random.within(0.0, 0.5);
    for (Outcome o = Outcome::flying; o != Outcome::time_limit;) {
      o = tip.advance_segment(next, &ended);
      for (const Segment& s : ended) add(s);
      if (o != Outcome::impact) continue;
      events += tip.last_impact().energy_loss;
      impacts += tip.last_impact().count;
    }
    const Segment open = tip.segment();
    split += open.kind == SegmentKind::chatter;
    add(open);
    tip.drag(GetParam().eta * random.within(0.99, 1.01));
    ASSERT_EQ(tip.segment().loss, 0.0);
    ASSERT_EQ(tip.segment().count, 0u);
  }
  while (tip.in_chatter()) {  // the last event is still open
    const Outcome o = tip.advance_segment({1000000, 0.0}, &ended);
    for (const Segment& s : ended) add(s);
    if (o != Outcome::impact) continue;
    events += tip.last_impact().energy_loss;
    impacts += tip.last_impact().count;
  }
  EXPECT_NEAR(static_cast<double>(segments), static_cast<double>(events), 1e-12 * static_cast<double>(events));
  EXPECT_EQ(counted, impacts);
  if (chatters()) {
    EXPECT_GT(split, 10);
  }
}

constexpr ModelKind kFree = ModelKind::oscillator, kHeld = ModelKind::hammer;
constexpr Scene kOscillators[] = {{kFree, 3.4, 0.34}, {kFree, -2.0, 0.02}, {kFree, 0.5, 0.01}, {kFree, 3.0, 0.01}};
constexpr Scene kHammers[] = {{kHeld, 3.4, 0.1}, {kHeld, -0.3, 0.02}};
constexpr Scene kInABath[] = {{kFree, 3.4, 0.05, 50.0, 0.926},
                              {kFree, 2.0, 0.05, 50.0},
                              {kFree, 0.1, 0.01, 50.0, 0.926},
                              {kFree, 0.3, 0.01, 50.0},
                              {kFree, 0.0, 0.05, 50.0, 0.3},
                              {kFree, 3.4, 0.0, 50.0, 0.926, 0.0, 0.0},
                              {kFree, 0.5, 0.05, 50.0, 1e-6, 0.0, 0.0},
                              {kFree, 0.0, 0.05, 50.0, 0.3, 0.0, 1.0},
                              {kFree, 0.3, 0.05, 50.0, 0.926, -3.0},
                              {kFree, 0.3, 0.0, 50.0, 0.926, -3.0, 0.0},
                              {kFree, 0.3, 0.05, 50.0, 0.926, -0.3},
                              {kHeld, 3.4, 0.05, 50.0, 0.926},
                              {kHeld, 0.3, 0.02, 50.0, 0.1},
                              {kHeld, 0.5, 0.05, 50.0, 0.05, 0.0, 0.0},
                              {kHeld, -0.3, 0.02, 50.0},
                              {kHeld, 0.3, 0.05, 50.0, 0.926, -0.3},
                              {kHeld, 0.3, 0.05, 50.0, 0.926, -3.0}};
INSTANTIATE_TEST_SUITE_P(Oscillator, SegmentsOf, testing::ValuesIn(kOscillators));
INSTANTIATE_TEST_SUITE_P(Hammer, SegmentsOf, testing::ValuesIn(kHammers));
INSTANTIATE_TEST_SUITE_P(InABath, SegmentsOf, testing::ValuesIn(kInABath));

// A tip that rests on a slope: its holder holds it, and nothing works.
TEST(Segment, AtRestTheHolderHoldsWithoutWork) {
  Model model;
  model.kind = ModelKind::hammer;
  Tip tip(model, 0.0, FreeState{0.1, 0.0, 0.09, 0.0, 0.0});
  while (tip.now() < ModelTime{500, 0.0}) tip.advance({500, 0.0});
  ASSERT_TRUE(tip.in_contact());
  const SurfaceJet<double> surface = surface_jet(model.H, tip.state().phase);
  const double force = surface.h1 * kTwoPi * kTwoPi * (surface.h - model.y0);
  Segments ended;
  for (int segments = 0; segments < 10; ++segments) {
    tip.advance_segment({1000000, 0.0}, &ended);
    for (const Segment& s : ended) {
      EXPECT_EQ(s.work(), 0.0);
      EXPECT_NEAR(s.impulse, force * (s.end - s.begin), 1e-12);
    }
  }
}

}  // namespace
}  // namespace afm
