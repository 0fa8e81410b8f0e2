// Restitution, cutoff, rest height, sample rate and friction window changed in mid-run.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "energy_ledger.h"
#include "random_launches.h"
#include "recorded_run.h"

namespace afm {
namespace {

Model random_model(RandomLaunches& random, double v_c) {
  Model model;
  model.gamma = random.within(0.05, 0.95);
  model.v_c = v_c * random.within(0.5, 2.0);
  model.y0 = random.within(-0.3, 0.09);
  return model;
}

Model small_cutoff() {
  Model model;
  model.v_c = 0.005;
  return model;
}

FreeState start_at(double eta) { return {0.25, 0.0, 0.2, eta, 0.0}; }

void advance_to(Tip& tip, const ModelTime& time) {
  while (tip.advance(time) != Outcome::time_limit) {
  }
}

TEST(Retune, InFlightTheTipIsAsIfLaunchedThere) {
  RandomLaunches random(7);
  Tip tip(Model{}, 3.4, start_at(3.4));
  int flights = 0;
  for (int i = 0; i < 2000; ++i) {
    advance_to(tip, tip.now() + random.within(0.0, 0.7));
    const TipState state = tip.tip_state();
    if (!(state.g > 0.0)) continue;
    const Model model = random_model(random, 0.05);
    tip.retune(model);
    Tip fresh(model, 3.4, state);
    Tip ahead = tip;
    for (Tip* t : {&fresh, &ahead}) ASSERT_EQ(t->advance(t->now() + 1000.0), Outcome::impact);
    ASSERT_EQ(ahead.last_impact().surface_phase, fresh.last_impact().surface_phase);
    ASSERT_EQ(ahead.last_impact().normal_speed, fresh.last_impact().normal_speed);
    ASSERT_EQ(ahead.last_impact().energy_loss, fresh.last_impact().energy_loss);
    ASSERT_NEAR(ahead.now() - tip.now(), fresh.now() - ModelTime{}, 1e-14 * (1.0 + (fresh.now() - ModelTime{})));
    ++flights;
  }
  EXPECT_GT(flights, 1000);
}

TEST(Retune, KeepsTheHammerAboveTheSurface) {
  RandomLaunches random(9);
  Model hammer = small_cutoff();
  hammer.kind = ModelKind::hammer;
  Tip tip(hammer, 0.5, start_at(0.5));
  int contacts = 0;
  for (int i = 0; i < 3000; ++i) {
    const ModelTime next = tip.now() + random.within(0.0, 0.5);
    for (Outcome o = Outcome::flying; o != Outcome::time_limit;) {
      o = tip.advance(next);
      ASSERT_NE(o, Outcome::search_failed);
    }
    contacts += tip.in_contact();
    const FreeState before = tip.state();
    Model model = random_model(random, 0.005);
    model.kind = ModelKind::hammer;
    tip.retune(model);
    ASSERT_NEAR(tip.state().y, before.y, 1e-5);
    ASSERT_EQ(tip.state().X, 0.0);
    ASSERT_GE(tip.deflection(tip.now()).gap, -1e-13);
  }
  EXPECT_GT(contacts, 20);
}

struct Run {
  double eta, v_c;
};

class RetuneEnergy : public testing::TestWithParam<Run> {};

// Whatever the tip is at: flight, burst, contact.
TEST_P(RetuneEnergy, IsConserved) {
  RandomLaunches random(11);
  Model model;
  model.v_c = GetParam().v_c;
  Tip tip(model, GetParam().eta, start_at(GetParam().eta));
  EnergyLedger ledger(model, tip);
  int bursts = 0, contacts = 0;
  for (int changes = 0; changes < 3000; ++changes) {
    const ModelTime next = tip.now() + random.within(0.0, 1.0);
    while (tip.now() < next) ASSERT_NE(ledger.advance_arc(tip, next), Outcome::search_failed);
    bursts += ledger.bursting();
    contacts += tip.in_contact();
    const FreeState before = tip.state();
    const bool free = tip.tip_state().g > 0.0;
    ledger.retune(tip, random_model(random, GetParam().v_c));
    // in a burst the tip is where its bounces are, not on its guide: beside it by less than the contact tolerance
    const double near = free || tip.in_contact() ? 1e-14 : 1e-5;
    ASSERT_NEAR(tip.state().y, before.y, near);
    ASSERT_NEAR(tip.state().X, before.X, near);
    ASSERT_NEAR(tip.state().u, before.u, 1e-2 * near * 1e5 * (std::abs(before.u) + 1.0));
    ledger.advance_arc(tip, tip.now());  // a burst is booked when it has ended
    ASSERT_LT(std::abs(ledger.imbalance(tip)), 1e-12 * ledger.turnover(tip)) << changes;
  }
  EXPECT_GT(ledger.lost(), 0.0);
  if (GetParam().v_c < 0.1) {
    EXPECT_GT(bursts + contacts, 20);
  }
}

INSTANTIATE_TEST_SUITE_P(Runs, RetuneEnergy,
                         testing::Values(Run{3.4, 0.3}, Run{0.5, 0.005},
                                         Run{-0.2, 0.002}, Run{3.0, 0.03}));

// A slow bounce: where the surface presses, a burst.
Tip slow_bounce(RandomLaunches& random, const Model& model, double eta) {
  const TipState start{random.within(0.0, 1.0), random.within(-0.02, 0.02), eta * random.within(0.7, 1.3), 0.0,
                       std::pow(10.0, random.within(-3.0, -2.0))};
  return {model, eta, start};
}

bool is_bursting(const Tip& tip) {
  const TipState state = tip.tip_state();
  return state.g == 0.0 && state.g1 == 0.0 && !tip.in_contact();
}

void advance_within_arc(RandomLaunches& random, Tip& tip) {
  tip.advance(tip.now() + random.within(0.0, 0.999) * (tip.arc_end() - tip.now()));
}

TEST(RetuneContact, GoesOnExactlyWhereTheSurfaceStillPresses) {
  RandomLaunches random(3);
  int stayed = 0, left = 0;
  while (stayed + left < 2000) {
    Tip tip = slow_bounce(random, small_cutoff(), 0.5);
    const ModelTime patience = tip.now() + 1.0;
    for (Outcome o = Outcome::flying; o != Outcome::contact && o != Outcome::time_limit;) o = tip.advance(patience);
    if (!tip.in_contact()) continue;
    advance_within_arc(random, tip);
    Tip changed = tip;
    const Model model = random_model(random, 0.005);
    changed.retune(model);
    const double pull = Flight<double>(Mechanics<double>(model), tip.eta(), tip.tip_state()).start().g2;
    const Outcome outcome = changed.advance(tip.now());
    ASSERT_EQ(outcome, pull < 0.0 ? Outcome::time_limit : Outcome::released) << pull;
    ASSERT_EQ(changed.in_contact(), pull < 0.0);
    if (outcome == Outcome::released) {
      ASSERT_EQ(changed.last_impact().kind, ImpactKind::contact_ended);
      ASSERT_TRUE(changed.last_impact().time == tip.now());
    }
    ++(pull < 0.0 ? stayed : left);
  }
  EXPECT_GT(stayed, 100);
  EXPECT_GT(left, 50);
}

TEST(RetuneBurst, EndsWithTheBounceItIsAt) {
  RandomLaunches random(5);
  for (int bursts = 0; bursts < 1000;) {
    Tip tip = slow_bounce(random, small_cutoff(), 0.5);
    if (!is_bursting(tip)) continue;
    advance_within_arc(random, tip);
    Tip changed = tip;
    changed.retune(random_model(random, 0.005));
    ASSERT_EQ(changed.advance(tip.now()), Outcome::impact);
    ASSERT_EQ(changed.last_impact().kind, ImpactKind::burst);
    ASSERT_TRUE(changed.now() == tip.now());
    ASSERT_GT(changed.tip_state().g1, 0.0);
    ASSERT_EQ(changed.tip_state().g, 0.0);
    ++bursts;
  }
}

EmulatorSettings settings_at(double eta, double sample_period, std::uint64_t samples_per_batch) {
  EmulatorSettings settings;
  settings.eta = eta;
  settings.initial = start_at(eta);
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
  Emulator plain(settings_at(3.4, 0.03, 500)), told(settings_at(3.4, 0.03, 500));
  RecordedRun truth, run;
  Batch a, b;
  for (int i = 0; i < 50; ++i) {
    plain.run_batch(a);
    told.change(live_settings(told.settings()));
    told.run_batch(b);
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
