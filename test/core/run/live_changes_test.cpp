// Restitution, cutoff, rest height, sample rate and friction window changed in mid-run: what the run reports.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "support/commands.h"
#include "support/recorded_run.h"
#include "trials/energy_balance.h"

namespace afm {
namespace {

TEST(SampleGrid, CountsFromItsOrigin) {
  const SampleGrid plain{0.03, 0, {}}, shifted{0.03, 7, {5, 0.9999}};
  for (const std::uint64_t n : {0u, 1u, 33u, 34u, 1000000u}) {
    EXPECT_TRUE(plain.time(n) == multiply(n, 0.03));
    const ModelTime time = shifted.time(7 + n);
    const ModelTime since = multiply(n, 0.03);
    EXPECT_TRUE((time == ModelTime{5 + since.tau, 0.9999} + since.phase));
    EXPECT_TRUE(time.phase >= 0.0 && time.phase < 1.0);
  }
}

// change(live, i): before the i-th batch.
template <class Change>
void expect_no_change(const Change& change) {
  afm::Run plain(settings_at(3.4, 500)), changed(settings_at(3.4, 500));
  RecordedRun truth, recorded;
  Batch a, b;
  for (int i = 0; i < 50; ++i) {
    plain.advance(a);
    RunSettings live = changed.settings();
    change(live, i);
    changed.apply(live);
    changed.advance(b);
    truth.append(a);
    recorded.append(b);
    ASSERT_EQ(a.friction.K_f, b.friction.K_f);
    ASSERT_TRUE(a.end == b.end);
  }
  expect_first_of(recorded, truth);
}

TEST(RunChange, ToTheSameIsNoChange) {
  expect_no_change([](RunSettings&, int) {});
}

TEST(RunChange, OfABathThatIsOffIsNoChange) {
  expect_no_change([](RunSettings& live, int i) {
    live.bath.kicks_per_tau = 10.0 + i;
    live.bath.temperature = i;
  });
}

TEST(RunChange, OfLeverSurfaceStartAndBudgetIsNoChange) {
  expect_no_change([](RunSettings& live, int) {
    live.model.frequency_ratio = 3.0;
    live.model.H = 0.2;
    live.initial.X = 0.3;
    live.impact_budget = 7;
  });
  afm::Run run(settings_at(3.4, 200));
  RunSettings other = run.settings();
  other.model.frequency_ratio = 3.0;
  run.apply(other);
  EXPECT_EQ(run.settings().model.frequency_ratio, Model{}.frequency_ratio);
}

// The tip does not know when it is looked at: with periods that are powers of 2 a finer grid holds the coarser one.
TEST(RunChange, OfTheSampleRateChangesTheSamplesAlone) {
  afm::Run fine(settings_at(3.4, 6400, 1.0 / 64)), changed(settings_at(3.4, 160, 1.0 / 16));
  Batch truth, batch;
  fine.advance(truth);
  std::uint64_t next = 0, stride = 4;
  std::vector<Impact> impacts;
  for (int i = 0; changed.now() < ModelTime{90, 0.0}; ++i) {
    changed.advance(batch);
    ASSERT_TRUE(batch.first_sample_time == batch.begin);
    for (std::size_t k = 0; k < batch.vertical.size(); ++k, next += stride) {
      ASSERT_EQ(batch.vertical[k], truth.vertical[next]);
      ASSERT_EQ(batch.lateral[k], truth.lateral[next]);
    }
    impacts.insert(impacts.end(), batch.impacts.begin(), batch.impacts.end());
    RunSettings live = changed.settings();
    stride = std::uint64_t{1} << (i % 4);
    live.sample_period = static_cast<double>(stride) / 64;
    live.samples_per_batch = 100 + 10 * static_cast<std::uint64_t>(i % 3);
    changed.apply(live);
  }
  ASSERT_GT(impacts.size(), 100u);
  for (std::size_t i = 0; i < impacts.size(); ++i) ASSERT_TRUE(same_bits(impacts[i], truth.impacts[i])) << i;
}

TEST(RunChange, OfTheSampleRateWithinABatchSamplesAtOnce) {
  afm::Run run(settings_at(3.4, 500));
  Batch batch;
  advance_to({1, 0.123}, run, batch);
  const std::uint64_t samples = run.samples();
  RunSettings live = run.settings();
  live.sample_period = 0.05;
  live.samples_per_batch = 10;
  run.apply(live);
  run.advance(batch);
  EXPECT_EQ(batch.first_sample, samples);
  EXPECT_TRUE((batch.first_sample_time == ModelTime{1, 0.123}));
  EXPECT_EQ(batch.vertical.size(), 10u);
  EXPECT_NEAR(batch.end - batch.begin, 0.5, 1e-15);
}

TEST(RunChange, OfTheRestitutionHoldsFromTheNextImpactOn) {
  afm::Run before(settings_at(3.4, 500)), after = before;
  Batch a, b;
  for (afm::Run* e : {&before, &after}) e->advance(a);
  RunSettings live = after.settings();
  live.model.gamma = 0.2;
  live.model.v_c = 0.01;
  after.apply(live);
  before.advance(a);
  after.advance(b);
  const Impact &kept = a.impacts.front(), &changed = b.impacts.front();
  EXPECT_NEAR(kept.normal_speed, changed.normal_speed, 1e-12);  // the flight was split there
  EXPECT_NEAR(changed.energy_loss, 0.5 * (1.0 - 0.04) * changed.normal_speed * changed.normal_speed, 1e-12);
  EXPECT_NEAR(kept.energy_loss, 0.5 * (1.0 - 0.49) * kept.normal_speed * kept.normal_speed, 1e-12);
}

TEST(RunChange, BeginsTheFrictionThatItConcernsAnew) {
  afm::Run run(settings_at(3.4, 5000)), plain(settings_at(3.4, 5000));
  Batch a, b;
  for (int i = 0; i < 3; ++i) plain.advance(a);
  for (int i = 0; i < 2; ++i) run.advance(b);
  RunSettings live = run.settings();
  live.friction_window = 64.0;
  run.apply(live);
  run.advance(b);
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
  live.model.y0 = 0.02;
  run.apply(live);
  run.advance(b);
  energy = 0.0;
  for (const Impact& impact : b.impacts) energy += impact.energy_loss;
  EXPECT_NEAR(b.friction.energy_loss, energy, 1e-12 * energy);
}

// Work of the drag = energy lost in impacts + heat to the bath + change of the stored energy, all since the change.
TEST(RunChange, OfTheBathOrTheDragVelocityBeginsTheBalanceAnew) {
  for (const double eta : {2.0, 3.4, 6.0}) {
    RunSettings settings = settings_at(eta, 100);
    settings.contact_tolerance = 0.0;  // no chatter sequence, along which the state is that of the reference slide
    afm::Run run(settings);
    Batch batch;
    for (int i = 1; i < 40; ++i) {
      run.advance(batch);
      RunSettings live = run.settings();
      if (i % 4 == 0) {
        live.eta *= 1.001;
      } else {
        live.bath.quality_factor = i % 3 == 0 ? 0.0 : 20.0 + i;
        live.bath.temperature = 0.1 * (i % 4);
      }
      run.apply(live);
      const ModelTime change = run.now();
      const double stored = stored_energy(run.settings().model, run.state());
      advance_to(change + 0.37, run, batch);
      const double work = run.eta() * batch.friction.mean_lateral_force * (run.now() - change);
      const double gain = stored_energy(run.settings().model, run.state()) - stored;
      double lost = 0.0;
      for (const Impact& impact : batch.impacts) lost += impact.energy_loss;
      ASSERT_NEAR(work, lost + batch.friction.heat_to_bath + gain, 1e-9) << eta << ", " << i;
    }
  }
}

TEST(Run, AHammerThatIsDampedInContactHasItsBalanceToo) {
  RunSettings settings = settings_at(0.05, 300);
  settings.model.kind = ModelKind::hammer;
  settings.model.y0 = -0.5;
  settings.bath.quality_factor = 100.0;
  settings.bath.kicks_per_tau = 843.618;  // too weak, each, to lift the tip
  afm::Run run(settings);
  const double stored = stored_energy(settings.model, run.state());
  Batch batch;
  for (int i = 0; i < 5; ++i) run.advance(batch);
  EXPECT_TRUE(batch.impacts.empty());  // it slides
  const FrictionEstimate& friction = batch.friction;
  const double work = run.eta() * friction.mean_lateral_force * (run.now() - ModelTime{});
  const double gain = stored_energy(settings.model, run.state()) - stored;
  EXPECT_NEAR(work, friction.energy_loss + friction.heat_to_bath + gain, 1e-12);
}

TEST(Run, TheHolderOfAHammerBeginsAboveItsTip) {
  RunSettings settings = settings_at(0.5, 100);
  settings.model.kind = ModelKind::hammer;
  settings.initial.X = 0.07;
  afm::Run run(settings);
  Batch batch;
  run.advance(batch);
  EXPECT_EQ(batch.holder, settings.initial.phase);
}

// The holder is where its spring says, also after a change to the hammer, which moves it above the tip.
TEST(RunChange, LeavesTheHolderWhereTheSpringOfTheTipEnds) {
  for (const double eta : {0.5, 3.4, -5.0}) {
    afm::Run run(settings_at(eta, 100));
    Batch batch;
    for (int i = 0; i < 300; ++i) {
      run.advance(batch);
      RunSettings live = run.settings();
      if (i % 3 == 0) live.eta = (i % 2 == 0 ? -1.01 : -0.99) * live.eta;
      if (i % 5 == 0) live.model.kind = i % 2 == 0 ? ModelKind::hammer : ModelKind::oscillator;
      if (i % 7 == 0) live.contact_tolerance = i % 2 == 0 ? 0.0 : 1e-3;
      run.apply(live);
      advance_to(run.now(), run, batch);
      const double holder = batch.holder - run.eta() * (batch.first_sample_time - run.now());
      const FreeState state = run.state();
      ASSERT_NEAR(std::remainder(holder + state.X - state.phase, 1.0), 0.0, 1e-9) << eta << ", " << i;
    }
  }
}

}  // namespace
}  // namespace afm
