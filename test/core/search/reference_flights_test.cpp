// Flight, search and reflection together, against flights computed elsewhere in 128-bit floats.
#include "support/reference_flights.h"

#include <gtest/gtest.h>

#include <cmath>
#include <tuple>

#include "afm/flight.h"
#include "afm/landing.h"
#include "afm/reflection.h"

namespace afm {
namespace {

constexpr double kEps = 2.2e-16;
constexpr double kHorizon = 1000.0;

// A file of test/data and the number of flights in it.
class ReferenceFlights : public testing::TestWithParam<std::tuple<const char*, std::size_t>> {
 protected:
  static std::vector<ReferenceFlight> flights() {
    return read_reference_flights(std::string(AFM_TEST_DATA) + "/" + std::get<0>(GetParam()));
  }
};

struct Flown {
  TipState start;
  Landing<double> landing;
  Reflection reflection;
};

Flown fly(const ReferenceFlight& f) {
  const Model model = f.model();
  const TipState start = f.start();
  const Landing<double> landing =
      find_landing(model, Flight<double>(SpringConstants<double>(model), f.eta, start), kHorizon);
  return {start, landing, reflect(model, f.eta, landing.jet)};
}

double error(double value, const Quad& truth) { return static_cast<double>(abs(value - truth)); }

// What the time of the impact can be known to: rounded inputs, the angle of departure, the angle of arrival.
double condition(const ReferenceFlight& f, double g1) {
  const double s = std::abs(f.u) + std::abs(f.w), dt = static_cast<double>(f.dt);
  const double v_n = static_cast<double>(f.normal_speed);
  return 4e-16 * dt + 2.0 * kEps * s * dt / g1 + 2.0 * kEps * (1.0 + s * dt) / v_n;
}

TEST_P(ReferenceFlights, AllAreThere) { EXPECT_EQ(flights().size(), std::get<1>(GetParam())); }

TEST_P(ReferenceFlights, TheImpactTimeIsRightToItsCondition) {
  double worst = 0.0;
  for (const ReferenceFlight& f : flights()) {
    const Flown flown = fly(f);
    ASSERT_EQ(flown.landing.outcome, SearchOutcome::impact) << f.phase;
    const double ratio = error(flown.landing.s, f.dt) / condition(f, flown.start.g1);
    EXPECT_LE(ratio, 1.0) << "dt " << flown.landing.s << " instead of " << f.dt << ", start phase " << f.phase;
    worst = std::max(worst, ratio);
  }
  RecordProperty("worst_share_of_the_bound", std::to_string(worst));
}

TEST_P(ReferenceFlights, TheStateAfterTheImpactIsRight) {
  int compared = 0;
  for (const ReferenceFlight& f : flights()) {
    const Flown flown = fly(f);
    if (!(f.normal_speed > 1e-2 && flown.start.g1 > 1e-2)) continue;
    ++compared;
    const double s = std::abs(f.u) + std::abs(f.w), near_enough = 1e-12 * s;
    const FreeState after = to_free_state(f.model().H, flown.reflection.after);
    EXPECT_LE(error(after.u, f.u_next), near_enough) << f.phase;
    EXPECT_LE(error(after.w, f.w_next), near_enough) << f.phase;
    EXPECT_LE(error(flown.reflection.normal_speed, f.normal_speed), near_enough) << f.phase;
    EXPECT_LE(error(flown.reflection.tangential_velocity, f.tangential_velocity), near_enough) << f.phase;
    EXPECT_LE(error(flown.reflection.energy_loss, f.energy_loss), near_enough * s) << f.phase;
    EXPECT_LE(error(after.X, f.X_next), near_enough) << f.phase;
    const double apart = error(after.phase, f.phase_next);
    EXPECT_LE(std::min(apart, std::abs(1.0 - apart)), near_enough) << f.phase;
  }
  EXPECT_GT(compared, 20);
}

INSTANTIATE_TEST_SUITE_P(Files, ReferenceFlights,
                         testing::Values(std::make_tuple("next_impact.csv", std::size_t{200}),
                                         std::make_tuple("next_impact_grazing.csv", std::size_t{60})));

}  // namespace
}  // namespace afm
