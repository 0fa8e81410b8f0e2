#include "afm/dynamics/poincare_map.h"

#include <gtest/gtest.h>

#include <cmath>

#include "afm/tip.h"

namespace afm {
namespace {

TEST(PoincareMap, IsTheTipFromImpactToImpact) {
  const Model model;
  const double eta = 3.4;
  const PoincareMap map(model, eta);
  Tip tip(model, eta, TipState{0.5, 0.003, 3.2, 0.0, 2.5}, 0.0);
  TipState now = tip.tip_state();
  for (int i = 0; i < 500; ++i) {
    const ModelTime before = tip.now();
    ASSERT_EQ(tip.advance(kEndOfTime), Outcome::impact);
    const MapStep step = map(now);
    ASSERT_EQ(step.outcome, MapOutcome::impact);
    now = tip.tip_state();
    // the state asked of a tip comes through its height: off by an ulp of the velocities, which the flight enlarges
    ASSERT_LE(section_difference(step.after, now).norm(), 1e-13);
    ASSERT_NEAR(step.dt, tip.now() - before, 1e-13);
    ASSERT_NEAR(step.energy_loss, tip.last_impact().energy_loss, 1e-12);
    ASSERT_NEAR(step.normal_speed, tip.last_impact().normal_speed, 1e-13);
    ASSERT_NEAR(step.tangential_velocity, tip.last_impact().tangential_velocity, 1e-13);
  }
}

TEST(PoincareMap, TellsWhereThereIsNoFlight) {
  const PoincareMap map(Model(), 3.4);
  EXPECT_EQ(map({0.3, 0.0, 3.4, 0.0, 0.0}).outcome, MapOutcome::no_flight);
  EXPECT_EQ(map({0.3, 0.0, 3.4, 0.0, -1.0}).outcome, MapOutcome::no_flight);
  EXPECT_EQ(map({0.3, 0.0, std::nan(""), 0.0, 1.0}).outcome, MapOutcome::no_flight);
}

// Flights that pass a crest ever lower, down to the touch: the clearance is the gap left there.
TEST(PoincareMap, ClearanceIsTheSmallestGapOnTheWay) {
  const double eta = 3.4;
  const PoincareMap map(Model(), eta);
  int passed = 0;
  for (double g1 = 1.0; g1 < 6.0; g1 += 0.005) {
    const TipState start{0.5, 0.0, eta, 0.0, g1};
    const MapStep step = map(start);
    const Flight<double> flight(SpringConstants<double>(Model()), eta, start);
    double smallest = INFINITY;
    constexpr int kPoints = 4000;
    double before = 0.0, now = flight.gap(step.dt / kPoints).g;
    for (int i = 2; i < kPoints; ++i) {
      const double next = flight.gap(step.dt * i / kPoints).g;
      if (now < before && now < next) smallest = std::min(smallest, now);
      before = now;
      now = next;
    }
    const double clearance = map.clearance(start, step.dt);
    ASSERT_EQ(std::isinf(clearance), std::isinf(smallest)) << g1;
    if (std::isinf(smallest)) continue;
    ++passed;
    ASSERT_NEAR(clearance, smallest, 1e-5) << g1;
    ASSERT_LE(clearance, smallest);
  }
  EXPECT_GT(passed, 100);
}

TEST(Section, DifferencesOfPhaseGoTheShorterWay) {
  const TipState a{0.99, 0.1, 1.0, 0.0, 2.0}, b{0.01, 0.2, 3.0, 0.0, 5.0};
  EXPECT_LE((section_difference(b, a) - Eigen::Vector4d(0.02, 0.1, 2.0, 3.0)).norm(), 1e-15);
  EXPECT_LE(section_difference(section_sum(a, section_difference(b, a)), b).norm(), 1e-15);
}

}  // namespace
}  // namespace afm
