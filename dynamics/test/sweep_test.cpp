#include "afm/dynamics/sweep.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <stdexcept>
#include <string>
#include <vector>

#include "afm/surface.h"
#include "common/decimal_range.h"
#include "support/models.h"

namespace afm {
namespace {

TipState plain_start(double eta) { return to_tip_state(Model{}.H, start_at(eta)); }

SweepSettings settings_of(double duration, double transient) {
  SweepSettings settings;
  settings.duration = duration;
  settings.transient = transient;
  return settings;
}

// The orbits of known_orbits_test: the closed form at even eta, and one that was iterated in 34 digits.
TEST(Sweep, OnAPeriodicOrbitTheFrictionIsExact) {
  constexpr double kGamma = 0.7;
  const double even = even_K_f(kGamma);
  const double known[][2] = {{2.0, even}, {6.0, even}, {2.25, 1.603774408582840476679226}};
  for (const auto& [eta, K_f] : known) {
    const SweepResult r = sweep_attractor({eta, kGamma, 0.1 * eta}, settings_of(1000.0, 500.0), plain_start(eta));
    EXPECT_EQ(r.attractor.rfind("period-", 0), 0u) << r.attractor;
    EXPECT_NEAR(r.friction.K_f, K_f, 1e-10) << eta;
    EXPECT_LT(r.friction.K_f_std_error, 1e-10) << eta;
    EXPECT_LE(r.largest_lyapunov, 0.0) << eta;
  }
}

TEST(Sweep, WhatTheEvenOrbitIsLike) {
  const double eta = 2.0, gamma = 0.7, s = kTwoPi * Model{}.H;
  const SweepResult r = sweep_attractor({eta, gamma, 0.1 * eta}, settings_of(1000.0, 500.0), plain_start(eta));
  const double speed = 2.0 * eta * s / ((1.0 - gamma) * std::sqrt(1.0 + s * s));
  EXPECT_NEAR(r.friction.impacts_per_tau, 2.0, 1e-12);
  EXPECT_NEAR(r.friction.mean_flight_time, 0.5, 1e-12);
  EXPECT_NEAR(r.friction.mean_energy_loss, 0.5 * (1.0 - gamma * gamma) * speed * speed, 1e-9);
}

TEST(Sweep, TheAttractorOfThePaperHasItsFriction) {
  for (const double v_c : {0.05, 0.34}) {
    const SweepResult r = sweep_attractor({3.4, 0.7, v_c}, settings_of(100000.0, 500.0), plain_start(3.4));
    EXPECT_EQ(r.attractor, "chaotic");
    EXPECT_GT(r.largest_lyapunov, 0.2);
    EXPECT_NEAR(r.friction.K_f, 0.2533, 3.0 * std::hypot(r.friction.K_f_std_error, 3e-4)) << v_c;
    EXPECT_LT(r.friction.K_f_std_error, 2e-4);
  }
}

// How many of the 95 % intervals of short runs hold the mean of a run of 1e7 tau, by both estimators.
struct Chaotic {
  double eta, K_f;  // v_c = 0.1 eta
};

class Coverage : public testing::TestWithParam<Chaotic> {};

TEST_P(Coverage, IsNineteenInTwenty) {
  constexpr int kSeeds = 3000;
  const Chaotic& known = GetParam();
  const SweepPoint point{known.eta, 0.7, 0.1 * known.eta};
  int covered = 0, covered_by_work = 0;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    Tip tip(model_of(point), point.eta, random_start(point, seed, 0));
    average_over_time(tip, 100.0);
    const FrictionAverage average = average_over_time(tip, 1000.0);
    covered += std::abs(average.K_f - known.K_f) < 1.96 * average.K_f_std_error ? 1 : 0;
    covered_by_work += std::abs(average.K_f_work - known.K_f) < 1.96 * average.K_f_work_std_error ? 1 : 0;
  }
  std::printf("eta = %g: %.1f %% and %.1f %%\n", known.eta, 100.0 * covered / kSeeds, 100.0 * covered_by_work / kSeeds);
  EXPECT_GE(covered, kSeeds * 93 / 100);
  EXPECT_LE(covered, kSeeds * 97 / 100);
  EXPECT_GE(covered_by_work, kSeeds * 93 / 100);
  EXPECT_LE(covered_by_work, kSeeds * 97 / 100);
}

INSTANTIATE_TEST_SUITE_P(Chaos, Coverage,
                         testing::Values(Chaotic{2.75, 0.28925}, Chaotic{3.4, 0.25305}, Chaotic{5.0, 0.18813}));

// The energy stored at the ends of the batches is many times the work between them.
TEST(Sweep, ASlowDragHasItsFrictionByTheWorkToo) {
  const SweepPoint point{0.02, 0.7, 0.05};
  const FrictionAverage a = sweep_point(point, settings_of(1000.0, 200.0), plain_start(point.eta)).friction;
  EXPECT_NEAR(a.K_f_work, 0.019, 3.0 * a.K_f_work_std_error);
  EXPECT_LT(a.K_f_work_std_error, 0.005);
}

// Without the laboratory there is the average over time alone.
TEST(Sweep, AnAverageOverTimeAgreesWithTheOneOverPeriods) {
  const SweepPoint point{4.5, 0.7, 0.45};
  const SweepSettings settings = settings_of(10000.0, 500.0);
  const SweepResult by_time = sweep_point(point, settings, plain_start(point.eta));
  const FrictionAverage exact = sweep_attractor(point, settings, plain_start(point.eta)).friction;
  EXPECT_EQ(by_time.attractor, "unknown");
  EXPECT_TRUE(std::isnan(by_time.largest_lyapunov));
  EXPECT_NEAR(by_time.friction.K_f, exact.K_f, 3.0 * by_time.friction.K_f_std_error);
  EXPECT_NEAR(by_time.friction.K_f_work, exact.K_f_work, 3.0 * by_time.friction.K_f_work_std_error);
}

TEST(Sweep, AtRestThereIsNoCoefficient) {
  const SweepResult r = sweep_attractor({0.0, 0.7, 0.05}, settings_of(100.0, 100.0), plain_start(0.0));
  EXPECT_TRUE(std::isnan(r.friction.K_f));
  EXPECT_TRUE(std::isnan(r.friction.K_f_std_error));
}

TEST(Sweep, StartsAreAboveTheSurfaceAndTheirOwn) {
  const SweepPoint point{3.4, 0.7, 0.05};
  for (std::uint64_t i = 0; i < 1000; ++i) {
    const TipState start = random_start(point, 7, i);
    ASSERT_GE(start.g, 0.0);
    ASSERT_EQ(random_start(point, 7, i).phase, start.phase);
    ASSERT_NE(random_start(point, 8, i).phase, start.phase);
    ASSERT_NE(random_start(point, 7, i + 1).phase, start.phase);
  }
}

TEST(DecimalRange, EveryValueIsTheNumberMeant) {
  const std::vector<double> values = parse_range("0:9:0.01");
  ASSERT_EQ(values.size(), 901u);
  for (std::size_t i = 0; i < values.size(); ++i) {
    ASSERT_EQ(values[i], std::strtod((std::to_string(i) + "e-2").c_str(), nullptr)) << i;
  }
  EXPECT_EQ(parse_range("1:2:0.3"), (std::vector<double>{1.0, 1.3, 1.6, 1.9}));
  EXPECT_EQ(parse_range("-0.2:.1:1e-1"), (std::vector<double>{-0.2, -0.1, 0.0, 0.1}));
  EXPECT_EQ(parse_range("3.4"), std::vector<double>{3.4});
  EXPECT_EQ(parse_range("1:1:1"), std::vector<double>{1.0});
  EXPECT_EQ(parse_range("3.4000000000000004"), std::vector<double>{3.4000000000000004});
}

TEST(DecimalRange, WhatIsNoRangeIsRefused) {
  for (const char* text : {"", "a", "1:2", "1:2:3:4", "1:2:0", "1:2:-1", "2:1:1", "1:2:x", "nan", "inf", "1e", "--1",
                           "1 ", "0:1:1e-9", "1:2:1e-30", "0x10", "1..2", ":", "1::2"}) {
    EXPECT_THROW(parse_range(text), std::invalid_argument) << text;
  }
}

}  // namespace
}  // namespace afm
