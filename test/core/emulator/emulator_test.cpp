#include "afm/emulator.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "support/recorded_run.h"
#include "trials/energy_balance.h"

namespace afm {
namespace {

EmulatorSettings settings_at(double eta, std::uint64_t samples_per_batch = 200) {
  EmulatorSettings settings;
  settings.eta = eta;
  settings.model.v_c = 0.1 * std::abs(eta);
  settings.initial = {0.25, 0.0, 0.2, eta, 0.0};
  settings.samples_per_batch = samples_per_batch;
  return settings;
}

// 0: no bath
class EmulatorAt : public testing::TestWithParam<double> {
 protected:
  static EmulatorSettings settings(std::uint64_t samples_per_batch) {
    EmulatorSettings settings = settings_at(3.4, samples_per_batch);
    settings.bath.temperature = GetParam();
    settings.bath.quality_factor = GetParam() > 0.0 ? 50.0 : 0.0;
    return settings;
  }
};

TEST_P(EmulatorAt, BatchesOfAnySizeAreOneLongRun) {
  Emulator whole(settings(12000));
  RecordedRun truth;
  Batch batch;
  ASSERT_EQ(whole.run_batch(batch), Outcome::time_limit);
  truth.append(batch);
  ASSERT_EQ(truth.vertical.size(), 12000u);
  for (const std::uint64_t size : {1u, 7u, 100u, 3000u}) {
    Emulator emulator(settings(size));
    RecordedRun run;
    while (run.vertical.size() < 12000 - size) {
      ASSERT_EQ(emulator.run_batch(batch), Outcome::time_limit);
      ASSERT_EQ(batch.vertical.size(), size);
      run.append(batch);
    }
    expect_first_of(run, truth);
  }
}

TEST_P(EmulatorAt, StoppingAnywhereChangesNothing) {
  Emulator whole(settings(4000)), stopped(settings(4000));
  RecordedRun truth, run;
  Batch batch;
  whole.run_batch(batch);
  truth.append(batch);
  const ModelTime end = batch.end;
  for (int i = 0; stopped.now() < end; ++i) {
    // by time, by impacts, to the boundary
    if (i % 3 == 0) stopped.run_until(std::min(stopped.now() + 0.777, end), batch);
    if (i % 3 == 1) stopped.run_impacts(3, batch);
    if (i % 3 == 2) stopped.run_until(std::min(stopped.now() + 0.0001, end), batch);
    run.append(batch);
  }
  EXPECT_TRUE(stopped.now() == end);
  EXPECT_EQ(run.vertical.size(), 4000u);
  expect_first_of(run, truth);
  EXPECT_EQ(run.impacts.size(), truth.impacts.size());
}

INSTANTIATE_TEST_SUITE_P(Temperatures, EmulatorAt, testing::Values(0.0, 0.926));

TEST(Emulator, SamplesAndImpactsFollowWithoutAGap) {
  const EmulatorSettings settings = settings_at(5.0, 333);
  Emulator emulator(settings);
  Batch batch;
  std::uint64_t samples = 0, impacts = 0;
  ModelTime end;
  for (int i = 0; i < 100; ++i) {
    ASSERT_EQ(emulator.run_batch(batch), Outcome::time_limit);
    ASSERT_EQ(batch.first_sample, samples);
    ASSERT_EQ(batch.first_impact, impacts);
    ASSERT_TRUE(batch.begin == end);
    ASSERT_TRUE(batch.first_sample_time == multiply(samples, settings.sample_period));
    for (const Impact& impact : batch.impacts) ASSERT_TRUE(batch.begin <= impact.time && impact.time <= batch.end);
    samples += batch.vertical.size();
    impacts += batch.impacts.size();
    end = batch.end;
    ASSERT_TRUE(end == multiply(samples, settings.sample_period));
  }
  EXPECT_GT(impacts, 1000u);
  EXPECT_EQ(emulator.counters().budget_exhausted, 0u);
  EXPECT_EQ(emulator.counters().search_failures, 0u);
  EXPECT_LT(emulator.counters().worst_penetration, 1e-13);
}

// Half of the run unsampled, in batches of every kind: the same impacts, and the same indices and samples afterwards.
TEST(Emulator, SamplesThatNobodyWantsAreCountedAndNotTaken) {
  const EmulatorSettings settings = settings_at(3.4, 333);
  Emulator listened(settings), ignored(settings);
  Batch a, b;
  for (int i = 0; i < 90; ++i) {
    const bool wanted = i % 7 < 3;
    ignored.take_samples(wanted);
    if (i % 5 == 4) {
      listened.run_impacts(3, a);
      ignored.run_impacts(3, b);
    } else if (i % 5 == 3) {
      const ModelTime stop = listened.now() + 0.4321 * i;
      while (listened.now() < stop && listened.run_impacts(1, a) != Outcome::time_limit) {
      }
      while (ignored.now() < stop && ignored.run_impacts(1, b) != Outcome::time_limit) {
      }
    } else {
      listened.run_batch(a);
      ignored.run_batch(b);
    }
    ASSERT_TRUE(listened.now() == ignored.now());
    ASSERT_EQ(listened.samples(), ignored.samples());
    ASSERT_EQ(a.first_sample, b.first_sample);
    ASSERT_EQ(a.friction.energy_loss, b.friction.energy_loss);
    ASSERT_EQ(a.impacts.size(), b.impacts.size());
    if (wanted) {
      ASSERT_EQ(a.vertical, b.vertical);
    } else {
      ASSERT_TRUE(b.vertical.empty() && b.lateral.empty());
    }
  }
}

TEST(Emulator, RunsToAnyTimeWithinABatch) {
  Emulator emulator(settings_at(2.0, 1000));  // 30 tau
  Batch batch;
  const ModelTime stop{7, 0.123};
  ASSERT_EQ(emulator.run_until(stop, batch), Outcome::time_limit);
  EXPECT_TRUE(emulator.now() == stop);
  EXPECT_TRUE(batch.end == stop);
  EXPECT_EQ(batch.vertical.size(), 238u);  // 0, 0.03 ... 7.11
  ASSERT_EQ(emulator.run_batch(batch), Outcome::time_limit);
  EXPECT_TRUE(batch.begin == stop);
  EXPECT_EQ(batch.first_sample, 238u);
  EXPECT_TRUE(batch.end == multiply(1000, 0.03));
}

TEST(Emulator, RunsToTheNthNextImpactOrTheBoundary) {
  Emulator emulator(settings_at(3.4, 1000));
  Batch batch;
  ASSERT_EQ(emulator.run_impacts(5, batch), Outcome::impact);
  ASSERT_EQ(batch.impacts.size(), 5u);
  EXPECT_TRUE(batch.end == batch.impacts.back().time);
  EXPECT_TRUE(emulator.now() == batch.end);
  ASSERT_EQ(emulator.run_impacts(1, batch), Outcome::impact);
  EXPECT_EQ(batch.first_impact, 5u);
  EXPECT_EQ(emulator.run_impacts(10000, batch), Outcome::time_limit);
  EXPECT_TRUE(batch.end == multiply(1000, 0.03));
}

// Stopped at an impact after the last sample of a batch and before the batch's end, which once was passed over.
TEST(Emulator, EndsABatchAlsoWhereAllItsSamplesAreTaken) {
  EmulatorSettings settings = settings_at(0.5, 2000);
  settings.model.v_c = 0.01;
  Emulator emulator(settings);
  Batch batch;
  int between = 0;
  while (emulator.now() < ModelTime{20000, 0.0}) {
    while (emulator.run_impacts(1, batch) == Outcome::impact) {
      const std::uint64_t n = emulator.samples() / 2000 * 2000;
      if (emulator.samples() != n || !(emulator.now() < multiply(n, 0.03))) continue;
      ++between;
      ASSERT_EQ(emulator.run_batch(batch), Outcome::time_limit);
      ASSERT_TRUE(batch.end == multiply(n, 0.03));
      ASSERT_TRUE(batch.vertical.empty());
    }
    ASSERT_TRUE(emulator.now() == multiply(emulator.samples(), 0.03));
  }
  EXPECT_GT(between, 3);
}

TEST(Emulator, TheSameCommandsGiveTheSameBits) {
  const double drags[] = {3.4, -2.0, 2.0, 2.0, 7.0, 3.4};
  RecordedRun runs[2];
  for (RecordedRun& run : runs) {
    Emulator emulator(settings_at(3.4, 300));
    Batch batch;
    for (int i = 0; i < 60; ++i) {
      if (i % 10 == 5) emulator.drag(drags[i / 10]);
      emulator.run_batch(batch);
      run.append(batch);
    }
  }
  EXPECT_EQ(runs[0].vertical.size(), 18000u);
  EXPECT_EQ(runs[0].impacts.size(), runs[1].impacts.size());
  expect_first_of(runs[0], runs[1]);
}

TEST(Emulator, ResetIsTheBeginning) {
  Emulator emulator(settings_at(3.4));
  Batch first, later;
  emulator.run_batch(first);
  emulator.drag(-1.0);
  emulator.run_impacts(1, later);
  emulator.reset();
  EXPECT_TRUE(emulator.now() == ModelTime{});
  EXPECT_EQ(emulator.eta(), 3.4);
  emulator.run_batch(later);
  EXPECT_EQ(later.first_sample, 0u);
  EXPECT_EQ(later.first_impact, 0u);
  EXPECT_EQ(later.vertical, first.vertical);
  EXPECT_EQ(later.lateral, first.lateral);
  EXPECT_EQ(later.friction.energy_loss, first.friction.energy_loss);
}

TEST(Emulator, ADragCommandStartsTheFrictionAgain) {
  Emulator emulator(settings_at(2.0, 3000));
  Batch batch;
  emulator.run_batch(batch);
  EXPECT_EQ(batch.eta, 2.0);
  emulator.drag(-4.0);
  emulator.run_batch(batch);
  EXPECT_EQ(batch.eta, -4.0);
  EXPECT_LT(batch.friction.force, 0.0);
  EXPECT_GT(batch.friction.K_f, 0.0);
  std::uint64_t bounces = 0;
  for (const Impact& impact : batch.impacts) bounces += impact.count;
  EXPECT_EQ(batch.friction.impact_count, bounces);
}

double lab_energy(const Emulator& emulator) { return stored_energy(emulator.settings().model, emulator.state()); }

TEST(Emulator, TheFrictionIsThatOfItsImpacts) {
  Emulator emulator(settings_at(3.4, 10000));
  Batch batch;
  double energy = 0.0;
  for (int i = 0; i < 10; ++i) {
    emulator.run_batch(batch);
    for (const Impact& impact : batch.impacts) energy += impact.energy_loss;
  }
  EXPECT_NEAR(batch.friction.energy_loss, energy, 1e-11 * energy);
  EXPECT_NEAR(batch.friction.K_f, energy / (3.4 * 3.4 * (batch.end - ModelTime{})), 1e-11);
  EXPECT_NEAR(batch.friction.K_f, 0.2533, 5.0 * batch.friction.K_f_std_error);  // of the attractor
}

// Eq. 1: the drag puts in what the impacts lose and what the tip stores.
TEST(Emulator, TheMeanLateralForceIsThePowerOfTheDragOverItsVelocity) {
  for (const double eta : {0.5, 2.0, 3.4, -5.0}) {
    Emulator emulator(settings_at(eta, 777));
    Batch batch;
    emulator.run_batch(batch);
    emulator.drag(1.001 * eta);
    const ModelTime begin = emulator.now();
    const double stored = lab_energy(emulator);
    for (int i = 0; i < 20; ++i) emulator.run_batch(batch);
    while (emulator.run_impacts(1, batch) != Outcome::impact) continue;
    const double work = batch.friction.energy_loss + lab_energy(emulator) - stored;
    const double force = work / (emulator.eta() * (emulator.now() - begin));
    EXPECT_NEAR(batch.friction.mean_lateral_force, force, 1e-12 * std::abs(eta) * std::abs(eta)) << eta;
  }
}

// Of the chaotic tip at 3.4: the error is no smaller than the scatter, and little larger.
TEST(Emulator, TheErrorOfTheMeanLateralForceIsThatOfRepeatedRuns) {
  constexpr int kRuns = 60;
  double mean = 0.0, square = 0.0, variance = 0.0;
  for (int i = 0; i < kRuns; ++i) {
    EmulatorSettings settings = settings_at(3.4, 330000);
    settings.initial.X = 1e-3 * i;
    Emulator emulator(settings);
    emulator.take_samples(false);
    Batch batch;
    emulator.run_until({10000, 0.0}, batch);
    while (emulator.now() < ModelTime{10000, 0.0}) emulator.run_until({10000, 0.0}, batch);
    const FrictionEstimate& e = batch.friction;
    mean += e.mean_lateral_force / kRuns;
    square += e.mean_lateral_force * e.mean_lateral_force / kRuns;
    variance += e.mean_lateral_force_std_error * e.mean_lateral_force_std_error / kRuns;
  }
  const double reported_over_found = std::sqrt(variance / (square - mean * mean));
  EXPECT_GT(reported_over_found, 0.9);
  EXPECT_LT(reported_over_found, 1.6);
}

}  // namespace
}  // namespace afm
