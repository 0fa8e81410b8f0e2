// Flight, search and reflection together, against flights from one impact to the next that were computed elsewhere in
// 128-bit floats with a guaranteed search: test/data/next_impact*.csv.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>
#include <string>
#include <tuple>
#include <vector>

#include "afm/single_flight.h"
#include "afm/surface.h"
#include "trials/quad.h"

namespace afm {
namespace {

constexpr double kEps = 2.2e-16;

// Natural units. u and w are after the impact, the normal speed and the tangential velocity before it.
struct ReferenceFlight {
  FlightInput start;  // exact
  Quad dt, phase, extension, u, w, normal_speed, tangential_velocity, energy_loss;

  double speed() const { return std::abs(start.u) + std::abs(start.w); }
  double gap_rate() const {
    return static_cast<double>(start.w - surface_jet(Quad(start.amplitude), Quad(start.phase)).h1 * start.u);
  }
  // What the time of the impact can be known to: rounded inputs, the angle of departure, the angle of arrival.
  double condition() const {
    const double s = speed(), t = static_cast<double>(dt), v_n = static_cast<double>(normal_speed);
    return 4e-16 * t + 2.0 * kEps * s * t / gap_rate() + 2.0 * kEps * (1.0 + s * t) / v_n;
  }
};

// A file of test/data and the number of flights in it.
class ReferenceFlights : public testing::TestWithParam<std::tuple<const char*, std::size_t>> {
 protected:
  static std::vector<ReferenceFlight> flights() {
    std::ifstream file(std::string(AFM_TEST_DATA) + "/" + std::get<0>(GetParam()));
    std::vector<ReferenceFlight> all;
    std::string line, field;
    std::getline(file, line);
    while (std::getline(file, line)) {
      std::vector<std::string> f;
      for (std::istringstream fields(line); std::getline(fields, field, ',');) f.push_back(field);
      const auto in = [&](std::size_t i) { return std::stod(f.at(i)); };
      const auto out = [&](std::size_t i) { return Quad(f.at(i)); };
      all.push_back({{in(0), in(1), in(2), in(3), in(4), in(5), in(6)},
                     out(7),
                     out(8),
                     out(9),
                     out(10),
                     out(11),
                     out(12),
                     out(13),
                     out(14)});
    }
    EXPECT_EQ(all.size(), std::get<1>(GetParam()));
    return all;
  }
};

double error(double value, const Quad& truth) { return static_cast<double>(abs(value - truth)); }

TEST_P(ReferenceFlights, TheImpactTimeIsRightToItsCondition) {
  for (const ReferenceFlight& f : flights()) {
    const double dt = fly_to_next_impact(f.start).dt;
    EXPECT_LE(error(dt, f.dt), f.condition()) << "dt " << dt << " instead of " << f.dt << ", phase " << f.start.phase;
  }
}

TEST_P(ReferenceFlights, TheStateAfterTheImpactIsRight) {
  int compared = 0;
  for (const ReferenceFlight& f : flights()) {
    if (!(f.normal_speed > 1e-2 && f.gap_rate() > 1e-2)) continue;
    ++compared;
    const FlightResult after = fly_to_next_impact(f.start);
    const double near_enough = 1e-12 * f.speed(), apart = error(after.phase, f.phase);
    EXPECT_LE(error(after.u, f.u), near_enough) << f.start.phase;
    EXPECT_LE(error(after.w, f.w), near_enough) << f.start.phase;
    EXPECT_LE(error(after.normal_speed, f.normal_speed), near_enough) << f.start.phase;
    EXPECT_LE(error(after.tangential_velocity, f.tangential_velocity), near_enough) << f.start.phase;
    EXPECT_LE(error(after.energy_loss, f.energy_loss), near_enough * f.speed()) << f.start.phase;
    EXPECT_LE(error(after.extension, f.extension), near_enough) << f.start.phase;
    EXPECT_LE(std::min(apart, std::abs(1.0 - apart)), near_enough) << f.start.phase;
  }
  EXPECT_GT(compared, 20);
}

INSTANTIATE_TEST_SUITE_P(Files, ReferenceFlights,
                         testing::Values(std::make_tuple("next_impact.csv", std::size_t{200}),
                                         std::make_tuple("next_impact_grazing.csv", std::size_t{60})));

}  // namespace
}  // namespace afm
