// Restitution, cutoff, rest height, sample rate and friction window changed in mid-run: what the emulator tells.
#include <gtest/gtest.h>

#include <vector>

#include "support/recorded_run.h"

namespace afm {
namespace {

EmulatorSettings settings_at(double eta, double sample_period, std::uint64_t samples_per_batch) {
  EmulatorSettings settings;
  settings.eta = eta;
  settings.initial = {0.25, 0.0, 0.2, eta, 0.0};
  settings.sample_period = sample_period;
  settings.samples_per_batch = samples_per_batch;
  return settings;
}

TEST(SampleGrid, CountsFromItsOrigin) {
  const SampleGrid plain{0.03, 0, {}}, moved{0.03, 7, {5, 0.9999}};
  for (const std::uint64_t n : {0u, 1u, 33u, 34u, 1000000u}) {
    EXPECT_TRUE(plain.time(n) == multiply(n, 0.03));
    const ModelTime time = moved.time(7 + n);
    const ModelTime since = multiply(n, 0.03);
    EXPECT_TRUE((time == ModelTime{5 + since.tau, 0.9999} + since.phase));
    EXPECT_TRUE(time.phase >= 0.0 && time.phase < 1.0);
  }
}

TEST(EmulatorChange, ToTheSameIsNoChange) {
  Emulator plain(settings_at(3.4, 0.03, 500)), changed(settings_at(3.4, 0.03, 500));
  RecordedRun truth, run;
  Batch a, b;
  for (int i = 0; i < 50; ++i) {
    plain.run_batch(a);
    changed.change(live_settings(changed.settings()));
    changed.run_batch(b);
    truth.append(a);
    run.append(b);
    ASSERT_EQ(a.friction.K_f, b.friction.K_f);
    ASSERT_TRUE(a.end == b.end);
  }
  expect_first_of(run, truth);
}

// The tip does not know when it is looked at: with periods that are powers of 2 a finer grid holds the coarser one.
TEST(EmulatorChange, OfTheSampleRateChangesTheSamplesAlone) {
  Emulator fine(settings_at(3.4, 1.0 / 64, 6400)), changed(settings_at(3.4, 1.0 / 16, 160));
  Batch truth, batch;
  fine.run_batch(truth);
  std::uint64_t next = 0, stride = 4;
  std::vector<Impact> impacts;
  for (int i = 0; changed.now() < ModelTime{90, 0.0}; ++i) {
    changed.run_batch(batch);
    ASSERT_TRUE(batch.first_sample_time == batch.begin);
    for (std::size_t k = 0; k < batch.vertical.size(); ++k, next += stride) {
      ASSERT_EQ(batch.vertical[k], truth.vertical[next]);
      ASSERT_EQ(batch.lateral[k], truth.lateral[next]);
    }
    impacts.insert(impacts.end(), batch.impacts.begin(), batch.impacts.end());
    LiveSettings live = live_settings(changed.settings());
    stride = std::uint64_t{1} << (i % 4);
    live.sample_period = static_cast<double>(stride) / 64;
    live.samples_per_batch = 100 + 10 * static_cast<std::uint64_t>(i % 3);
    changed.change(live);
  }
  ASSERT_GT(impacts.size(), 100u);
  for (std::size_t i = 0; i < impacts.size(); ++i) ASSERT_TRUE(same_bits(impacts[i], truth.impacts[i])) << i;
}

TEST(EmulatorChange, OfTheSampleRateWithinABatchSamplesAtOnce) {
  Emulator emulator(settings_at(3.4, 0.03, 500));
  Batch batch;
  emulator.run_until({1, 0.123}, batch);
  const std::uint64_t samples = emulator.samples();
  LiveSettings live = live_settings(emulator.settings());
  live.sample_period = 0.05;
  live.samples_per_batch = 10;
  emulator.change(live);
  emulator.run_batch(batch);
  EXPECT_EQ(batch.first_sample, samples);
  EXPECT_TRUE((batch.first_sample_time == ModelTime{1, 0.123}));
  EXPECT_EQ(batch.vertical.size(), 10u);
  EXPECT_NEAR(batch.end - batch.begin, 0.5, 1e-15);
}

TEST(EmulatorChange, OfTheRestitutionHoldsFromTheNextImpactOn) {
  Emulator before(settings_at(3.4, 0.03, 500)), after = before;
  Batch a, b;
  for (Emulator* e : {&before, &after}) e->run_batch(a);
  LiveSettings live = live_settings(after.settings());
  live.gamma = 0.2;
  live.v_c = 0.01;
  after.change(live);
  before.run_batch(a);
  after.run_batch(b);
  const Impact &kept = a.impacts.front(), &changed = b.impacts.front();
  EXPECT_NEAR(kept.normal_speed, changed.normal_speed, 1e-12);  // the flight was split there
  EXPECT_NEAR(changed.energy_loss, 0.5 * (1.0 - 0.04) * changed.normal_speed * changed.normal_speed, 1e-12);
  EXPECT_NEAR(kept.energy_loss, 0.5 * (1.0 - 0.49) * kept.normal_speed * kept.normal_speed, 1e-12);
}

TEST(EmulatorChange, BeginsTheFrictionThatItConcernsAnew) {
  Emulator emulator(settings_at(3.4, 0.03, 5000)), plain(settings_at(3.4, 0.03, 5000));
  Batch a, b;
  for (int i = 0; i < 3; ++i) plain.run_batch(a);
  for (int i = 0; i < 2; ++i) emulator.run_batch(b);
  LiveSettings live = live_settings(emulator.settings());
  live.friction_window = 64.0;
  emulator.change(live);
  emulator.run_batch(b);
  EXPECT_EQ(a.friction.K_f, b.friction.K_f);
  EXPECT_EQ(a.friction.K_f_std_error, b.friction.K_f_std_error);
  EXPECT_EQ(a.friction.impact_count, b.friction.impact_count);
  EXPECT_NE(a.friction.window_K_f, b.friction.window_K_f);
  double energy = 0.0;  // of the last 32 whole bins of 2 tau since the change, 150 tau ago
  for (const Impact& impact : b.impacts) {
    const double age = impact.time - b.begin;
    if (age >= 86.0 && age < 150.0) energy += impact.energy_loss;
  }
  EXPECT_NEAR(b.friction.window_K_f, energy / 64.0 / (3.4 * 3.4), 0.05 * b.friction.window_K_f);
  live.y0 = 0.02;
  emulator.change(live);
  emulator.run_batch(b);
  energy = 0.0;
  for (const Impact& impact : b.impacts) energy += impact.energy_loss;
  EXPECT_NEAR(b.friction.energy_loss, energy, 1e-12 * energy);
}

TEST(EmulatorChange, OutlastsAReset) {
  EmulatorSettings other = settings_at(3.4, 0.05, 300);
  other.model.gamma = 0.5;
  other.model.y0 = -0.02;
  Emulator changed(settings_at(3.4, 0.03, 500)), fresh(other);
  Batch a, b;
  changed.run_batch(a);
  changed.change(live_settings(other));
  changed.run_batch(a);
  changed.reset();
  for (int i = 0; i < 5; ++i) {
    changed.run_batch(a);
    fresh.run_batch(b);
    ASSERT_EQ(a.vertical, b.vertical);
    ASSERT_TRUE(a.end == b.end);
    ASSERT_EQ(a.friction.K_f, b.friction.K_f);
  }
}

}  // namespace
}  // namespace afm
