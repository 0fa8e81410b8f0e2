#include "afm/run.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "support/commands.h"
#include "support/recorded_run.h"

namespace afm {
namespace {

// Impacts, chatter and contact at this temperature; 0: no bath.
class RunAt : public testing::TestWithParam<double> {
 protected:
  static RunSettings settings(std::uint64_t samples_per_batch) {
    RunSettings settings = settings_at(3.0, samples_per_batch);
    settings.model.v_c = 0.02;
    settings.bath.temperature = GetParam();
    settings.bath.quality_factor = GetParam() > 0.0 ? 50.0 : 0.0;
    return settings;
  }
};

TEST_P(RunAt, BatchesOfAnySizeAreOneLongRun) {
  afm::Run whole(settings(12000));
  RecordedRun truth;
  Batch batch;
  ASSERT_EQ(whole.advance(batch), Outcome::time_limit);
  truth.append(batch);
  ASSERT_EQ(truth.vertical.size(), 12000u);
  for (const std::uint64_t size : {1u, 7u, 100u, 3000u}) {
    afm::Run run(settings(size));
    RecordedRun recorded;
    for (double worst = 0.0; recorded.vertical.size() < 12000 - size; worst = run.counters().worst_penetration) {
      ASSERT_EQ(run.advance(batch), Outcome::time_limit);
      ASSERT_GE(run.counters().worst_penetration, worst);
      ASSERT_EQ(batch.vertical.size(), size);
      ASSERT_TRUE(batch.first_sample_time == multiply(batch.first_sample, run.settings().sample_period));
      recorded.append(batch);
    }
    EXPECT_EQ(run.counters().budget_exhausted + run.counters().search_failures, 0u);
    EXPECT_LT(run.counters().worst_penetration, 1e-13);
    expect_first_of(recorded, truth);
  }
}

TEST_P(RunAt, StoppingAnywhereChangesNothing) {
  afm::Run whole(settings(4000)), stopped(settings(4000));
  RecordedRun truth, recorded;
  Batch batch;
  whole.advance(batch);
  truth.append(batch);
  const ModelTime end = batch.end;
  for (int i = 0; stopped.now() < end; ++i) {
    // by time, by impacts, to the boundary
    if (i % 3 == 0) advance_to(std::min(stopped.now() + 0.777, end), stopped, batch);
    if (i % 3 == 1) advance_impacts(3, stopped, batch);
    if (i % 3 == 2) advance_to(std::min(stopped.now() + 0.0001, end), stopped, batch);
    recorded.append(batch);
  }
  EXPECT_TRUE(stopped.now() == end);
  EXPECT_EQ(recorded.vertical.size(), 4000u);
  expect_first_of(recorded, truth);
  EXPECT_EQ(recorded.impacts.size(), truth.impacts.size());
}

INSTANTIATE_TEST_SUITE_P(Temperatures, RunAt, testing::Values(0.0, 0.926));

TEST(Run, RunsToTheNthNextImpactOrTheBoundary) {
  afm::Run run(settings_at(3.4, 1000));
  Batch batch;
  ASSERT_EQ(advance_impacts(5, run, batch), Outcome::budget_spent);
  ASSERT_EQ(batch.impacts.size(), 5u);
  EXPECT_TRUE(batch.end == batch.impacts.back().time);
  EXPECT_TRUE(run.now() == batch.end);
  ASSERT_EQ(advance_impacts(1, run, batch), Outcome::budget_spent);
  EXPECT_EQ(batch.first_impact, 5u);
  EXPECT_EQ(advance_impacts(10000, run, batch), Outcome::time_limit);
  EXPECT_TRUE(batch.end == multiply(1000, 0.03));
}

// Stopped at an impact after the last sample of a batch and before the batch's end, which once was passed over.
TEST(Run, EndsABatchAlsoWhereAllItsSamplesAreTaken) {
  RunSettings settings = settings_at(0.5, 2000);
  settings.model.v_c = 0.01;
  afm::Run run(settings);
  Batch batch;
  int between = 0;
  while (run.now() < ModelTime{20000, 0.0}) {
    while (advance_impacts(1, run, batch) == Outcome::budget_spent) {
      const std::uint64_t n = run.samples() / 2000 * 2000;
      if (run.samples() != n || !(run.now() < multiply(n, 0.03))) continue;
      ++between;
      ASSERT_EQ(run.advance(batch), Outcome::time_limit);
      ASSERT_TRUE(batch.end == multiply(n, 0.03));
      ASSERT_TRUE(batch.vertical.empty());
    }
    ASSERT_TRUE(run.now() == multiply(run.samples(), 0.03));
  }
  EXPECT_GT(between, 3);
}

TEST(Run, TheFrictionIsThatOfItsImpacts) {
  afm::Run run(settings_at(3.4, 10000));
  Batch batch;
  double energy = 0.0;
  std::uint64_t bounces = 0;
  for (int i = 0; i < 10; ++i) {
    run.advance(batch);
    for (const Impact& impact : batch.impacts) energy += impact.energy_loss, bounces += impact.count;
  }
  EXPECT_EQ(batch.friction.impact_count, bounces);
  EXPECT_NEAR(batch.friction.energy_loss, energy, 1e-11 * energy);
  EXPECT_NEAR(batch.friction.K_f, energy / (3.4 * 3.4 * (batch.end - ModelTime{})), 1e-11);
  EXPECT_NEAR(batch.friction.K_f, 0.2533, 5.0 * batch.friction.K_f_std_error);  // of the attractor
}

// On average the holder presses with the force of the vertical spring, also over a snapshot.
TEST(Run, TheMeanNormalForceIsThatOfTheSamples) {
  for (const double y0 : {0.0, -0.5}) {
    RunSettings settings = settings_at(3.4, 1000);
    settings.model.y0 = y0;
    afm::Run run(settings);
    Batch batch;
    double vertical = 0.0;
    std::size_t samples = 0;
    for (int i = 0; i < 50; ++i) {
      if (i == 20) run = afm::Run(run.split());
      run.advance(batch);
      for (const double y : batch.vertical) vertical += y;
      samples += batch.vertical.size();
    }
    const double force = kTwoPi * kTwoPi * vertical / static_cast<double>(samples);
    EXPECT_NEAR(batch.friction.mean_normal_force, force, 1e-12);
    drag(run, 1.0);
    run.advance(ModelTime(run.now()), 1, batch);
    EXPECT_TRUE(std::isnan(batch.friction.mean_normal_force));  // no sample yet
  }
}

// Means of the samples are not: the hammer has none along x, and a periodic motion may be seen at few phases.
TEST(Run, TheImpulseOfABatchIsThatOfTheFrictionEstimate) {
  for (const ModelKind kind : {ModelKind::oscillator, ModelKind::hammer}) {
    RunSettings settings = settings_at(2.0, 330000);
    settings.model.kind = kind;
    afm::Run run(settings);
    Batch batch;
    double impulse = 0.0;
    for (int i = 0; i < 40; ++i) {
      run.advance(run.now() + 1.7, 3 + i, batch);  // in the middle of flights, and after some impacts
      impulse += batch.impulse;
      if (i % 7 == 6) run.split();
    }
    EXPECT_NEAR(impulse / (batch.friction.mean_lateral_force * (run.now() - ModelTime{})), 1.0, 1e-12);
  }
}

// The root mean square of the errors of runs from several starts over the scatter of their means.
double reported_over_found(const Bath& bath, const ModelTime& end) {
  constexpr int kRuns = 60;
  double mean = 0.0, square = 0.0, variance = 0.0;
  for (int i = 0; i < kRuns; ++i) {
    RunSettings settings = settings_at(3.4, 330000);
    settings.initial.X = 1e-3 * i;
    settings.bath = bath;
    settings.bath.seed = static_cast<std::uint64_t>(i);
    afm::Run run(settings);
    Batch batch;
    advance_to(end, run, batch);
    while (run.now() < end) advance_to(end, run, batch);
    const FrictionEstimate& e = batch.friction;
    mean += e.mean_lateral_force / kRuns;
    square += e.mean_lateral_force * e.mean_lateral_force / kRuns;
    variance += e.mean_lateral_force_std_error * e.mean_lateral_force_std_error / kRuns;
  }
  return std::sqrt(variance / (square - mean * mean));
}

// Of the chaotic tip at 3.4: the error is no smaller than the scatter, and little larger, but in a short run with a
// bath.
TEST(Run, TheErrorOfTheMeanLateralForceIsThatOfRepeatedRuns) {
  const double cold = reported_over_found(Bath{}, {10000, 0.0}),
               heated = reported_over_found({0.926, 100.0}, {1000, 0.0});
  EXPECT_GT(cold, 0.9);
  EXPECT_LT(cold, 1.6);
  EXPECT_GT(heated, 0.9);
  EXPECT_LT(heated, 4.0);
}

// The energy stored at the ends of the bins is many times the work between them.
TEST(Run, ASlowDragHasItsFrictionByTheWorkToo) {
  afm::Run run(settings_at(0.03, 330000));
  Batch batch;
  while (run.now() < ModelTime{200, 0.0}) advance_to({200, 0.0}, run, batch);
  drag(run, 0.02);
  while (run.now() < ModelTime{1200, 0.0}) advance_to({1200, 0.0}, run, batch);
  const FrictionEstimate& e = batch.friction;
  EXPECT_NEAR(e.K_f_work, 0.019, 3.0 * e.K_f_work_std_error);
  EXPECT_LT(e.K_f_work_std_error, 0.005);
  EXPECT_DOUBLE_EQ(e.mean_lateral_force_std_error, 0.02 * e.K_f_work_std_error);
}

}  // namespace
}  // namespace afm
