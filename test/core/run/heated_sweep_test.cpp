// K_f by the work of the drag does not depend on the rate of kicks, the default against four times as many; nor on the
// contact tolerance.
#include <gtest/gtest.h>

#include <cmath>

#include "afm/run.h"
#include "afm/sweep.h"
#include "support/models.h"

namespace afm {
namespace {

struct Measured {
  double K_f, error;
};

Measured measure(double eta, double quality_factor, double temperature, double kicks_per_tau) {
  const SweepPoint point{eta, 0.7, 0.05};
  SweepSettings settings;
  settings.duration = 20000.0;
  settings.transient = 500.0;
  settings.bath.temperature = temperature;
  settings.bath.quality_factor = quality_factor;
  settings.bath.kicks_per_tau = kicks_per_tau;
  const FrictionAverage friction = sweep_point(point, settings, random_start(point, 1, 0)).friction;
  return {friction.K_f_work, friction.K_f_work_std_error};
}

constexpr double kBias = 0.005;  // allowed, relative

double bias_beyond_noise(double eta, double quality_factor, double temperature, double kicks_per_tau) {
  const Measured many = measure(eta, quality_factor, temperature, 4.0 * Bath{}.kicks_per_tau),
                 few = measure(eta, quality_factor, temperature, kicks_per_tau);
  return std::fmax(0.0, std::abs(few.K_f - many.K_f) - 4.0 * std::hypot(few.error, many.error)) / many.K_f;
}

struct Setting {
  double eta, quality_factor, temperature;
};
class HeatedSweep : public testing::TestWithParam<Setting> {};

TEST_P(HeatedSweep, TheDefaultRateOfKicksIsEnough) {
  const auto [eta, quality_factor, temperature] = GetParam();
  EXPECT_LT(bias_beyond_noise(eta, quality_factor, temperature, Bath{}.kicks_per_tau), kBias);
}
INSTANTIATE_TEST_SUITE_P(Settings, HeatedSweep,
                         testing::Values(Setting{2.0, 100.0, 0.926}, Setting{2.0, 20.0, 0.926}, Setting{2.0, 20.0, 0.0},
                                         Setting{3.4, 20.0, 0.926}, Setting{6.0, 100.0, 0.0},
                                         Setting{6.0, 500.0, 0.926}));

// Strobing: kicks at a whole rate come always at the same phases of an orbit of even eta. The start decides at which:
// four starts are 4, 6, 33 and 36 % off.
TEST(HeatedSweep, AWholeRateIsNot) { EXPECT_GT(bias_beyond_noise(2.0, 100.0, 0.926, 2.0), 4.0 * kBias); }

// Kicks that lock to the drag meet the same phase of the surface in every cell, which the start decides.
TEST(HeatedSweep, WhereKicksLockToTheDragTheStartDecides) {
  constexpr double eta = 29.034;
  const auto spread_over_error = [](double kicks_per_tau) {
    const SweepPoint point{eta, 0.7, 0.05};
    SweepSettings settings;
    settings.transient = 6000.0;  // it was 200: some dance for 2200 tau before they lock
    settings.duration = 2000.0;
    settings.bath.quality_factor = 20.0;
    settings.bath.kicks_per_tau = kicks_per_tau;
    constexpr int kStarts = 8;
    double least = INFINITY, greatest = 0.0, error = 0.0;
    for (std::uint64_t start = 0; start < kStarts; ++start) {
      const FrictionAverage friction = sweep_point(point, settings, random_start(point, 1, start)).friction;
      least = std::fmin(least, friction.K_f_work);
      greatest = std::fmax(greatest, friction.K_f_work);
      error += friction.K_f_work_std_error / kStarts;
    }
    return (greatest - least) / error;
  };
  Bath bath;
  bath.quality_factor = 20.0;
  EXPECT_GT(spread_over_error(bath.kicks_per_tau), 20.0);
  EXPECT_LT(spread_over_error(suitable_kicks(Model{}, bath, eta)), 6.0);
}

// Bins of whole tau end where the surface repeats, so that their scatter was none: it was off by up to 170 errors.
TEST(DampedRun, TheErrorInContactHoldsWhatTheTipHasStored) {
  const SweepPoint point{1.0, 0.7, 0.05, ModelKind::oscillator, -3.0};
  RunSettings settings;
  settings.model = model_of(point);
  settings.eta = point.eta;
  settings.samples_per_batch = 2001;  // 63.7 tau
  settings.bath.quality_factor = 100.0;
  Tip tip(settings.model, settings.eta, lowered_tip(settings.model.H));
  tip.set_bath(settings.bath);
  average_over_time(tip, 2000.0);
  const double K_f = average_over_time(tip, 6400.0).K_f_work;  // batches of 100 cells, and of 2903.4 kicks
  afm::Run run(settings);
  Batch batch;
  int held = 0;
  constexpr int kBatches = 100;
  for (int i = 0; i < kBatches; ++i) {
    run.advance(batch);
    held += i >= 20 && std::abs(batch.friction.K_f_work - K_f) < 1.96 * batch.friction.K_f_work_std_error ? 1 : 0;
  }
  EXPECT_GT(held, 70);  // of 80
}

// Of a light tip under a load, which is mostly down.
double K_f_of(double contact_tolerance, std::uint64_t seed) {
  RunSettings settings;
  settings.model.y0 = -1.0;
  settings.model.frequency_ratio = 21.0;
  settings.eta = 3.0;
  settings.contact_tolerance = contact_tolerance;
  settings.bath = {0.926, 100.0, 0.0, 12.979, seed};
  Run run(settings);
  Batch batch;
  while (run.now() < ModelTime{1000}) run.advance(batch);
  return batch.friction.K_f_work;
}

// At the default tolerance the bounces that a kick starts are one event. It once made K_f 9 % too high here. It is
// 1.5 % in 96 runs, and the noise of a run with the same kicks 2.3 %.
TEST(HeatedRun, HasTheFrictionOfAFinerTolerance) {
  constexpr int kRuns = 32;
  double coarse = 0.0, fine = 0.0;
  for (std::uint64_t seed = 1; seed <= kRuns; ++seed) {
    coarse += K_f_of(kDefaultContactTolerance, seed) / kRuns;
    fine += K_f_of(1e-6, seed) / kRuns;
  }
  EXPECT_NEAR(coarse, fine, 0.03 * fine);
}

}  // namespace
}  // namespace afm
