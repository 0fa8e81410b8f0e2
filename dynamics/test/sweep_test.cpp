#include "afm/dynamics/sweep.h"

#include <gtest/gtest.h>

#include <cmath>

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

}  // namespace
}  // namespace afm
