// Flights built to pass a crest at a given depth: deeper than rounding, and within it.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "afm_emulator/impact_search.h"
#include "quad.h"
#include "random_launches.h"

namespace afm {
namespace {

const Model kMica;
const Mechanics<Quad> kQuadMechanics(kMica);
constexpr double kHorizon = 8.0;

struct Graze {
  bool built;
  double eta;
  TipState start;
  double s;  // of the graze
};

// Runs time backwards from a point `clearance` above the surface with no gap rate, to the impact before.
Graze build_graze(RandomLaunches& random, double clearance) {
  const double eta = random.within(0.5, 9.0), phase = random.within(-0.2, 0.2);
  const TipState top{phase, random.within(-0.03, 0.03), -eta * random.within(0.7, 1.3), clearance, 0.0};
  const Flight<Quad> back(kQuadMechanics, -eta, top);
  if (!(back.start().g2 > 1)) return {};
  const Quad clear = sqrt(Quad(0.01) / back.start().g2);  // by then the gap is beyond any rounding
  if (!(back.gap(clear).g > Quad(0.001))) return {};
  const Landing<Quad> before = find_impact(Flight<Quad>(kQuadMechanics, -eta, back.tip_state(clear)), Quad(kHorizon));
  if (before.outcome != SearchOutcome::impact) return {};
  const FlightState<Quad>& q = before.jet.state;
  const TipState start{wrap_phase(static_cast<double>(q.phase)), static_cast<double>(q.X),
                       -static_cast<double>(q.U - eta), 0.0, -static_cast<double>(before.jet.g1)};
  return {start.g1 > 1e-2, eta, start, static_cast<double>(clear + before.s)};
}

struct Count {
  int touched = 0, missed = 0;
};

// What exact arithmetic says of the same start.
void compare_with_quad(const Graze& graze, double clearance, Count& count) {
  const Landing<Quad> truth = find_impact(Flight<Quad>(kQuadMechanics, graze.eta, graze.start), Quad(kHorizon));
  ASSERT_NE(truth.outcome, SearchOutcome::undecided);
  const Flight<double> flight(Mechanics<double>(kMica), graze.eta, graze.start);
  const Landing<double> landing = find_landing(kMica, flight, kHorizon);
  ASSERT_EQ(landing.outcome, truth.outcome) << clearance;
  // a wrong decision is a whole flight away
  ASSERT_NEAR(landing.s, static_cast<double>(truth.s), 1e-6) << clearance;
  const double halfway = std::sqrt(std::abs(clearance)) + 1e-6;
  ++(truth.s < graze.s + halfway ? count.touched : count.missed);
}

Count graze_many(double clearance, unsigned seed) {
  RandomLaunches random(seed);
  Count count;
  for (int built = 0; built < 40;) {
    const Graze graze = build_graze(random, clearance);
    if (!graze.built) continue;
    compare_with_quad(graze, clearance, count);
    if (testing::Test::HasFatalFailure()) break;
    ++built;
  }
  return count;
}

class Grazing : public testing::TestWithParam<int> {};

TEST_P(Grazing, AboveTheCrestByRoundingOrMoreIsAMiss) {
  const Count count = graze_many(std::pow(10.0, -GetParam()), 1);
  EXPECT_GT(count.missed, 20);
}

TEST_P(Grazing, BelowTheCrestByRoundingOrMoreIsATouch) {
  const Count count = graze_many(-std::pow(10.0, -GetParam()), 2);
  EXPECT_EQ(count.missed, 0);
}

INSTANTIATE_TEST_SUITE_P(Depths, Grazing, testing::Range(3, 15));

TEST(Grazing, WithinRoundingTheExactAnswerIsFound) {
  // aimed at 0, each comes out a rounding error above or below it
  const Count count = graze_many(0.0, 3), more = graze_many(0.0, 4), most = graze_many(0.0, 5);
  EXPECT_GT(count.touched + more.touched + most.touched, 20);
  EXPECT_GT(count.missed + more.missed + most.missed, 20);
}

TEST(Grazing, ATouchBelowTheDigitsOfDoubleHasAnImpactOfNoSpeed) {
  RandomLaunches random(6);
  int hidden = 0;
  for (int i = 0; i < 400; ++i) {
    const Graze graze = build_graze(random, 0.0);
    if (!graze.built) continue;
    const Flight<double> flight(Mechanics<double>(kMica), graze.eta, graze.start);
    if (find_impact(flight, kHorizon).outcome != SearchOutcome::undecided) continue;
    ++hidden;
    const Landing<double> landing = find_landing(kMica, flight, kHorizon);
    ASSERT_NE(landing.outcome, SearchOutcome::undecided);
    if (landing.s > graze.s + 1e-5) continue;
    ASSERT_LE(landing.jet.g1, 0.0);
    ASSERT_GT(landing.jet.g1, -1e-5);
  }
  EXPECT_GT(hidden, 20);
}

}  // namespace
}  // namespace afm
