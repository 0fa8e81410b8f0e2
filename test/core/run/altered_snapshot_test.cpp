// A snapshot with an altered number is refused, or its run ends its batches; one of any run has no fault.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include "support/random_runs.h"

namespace afm {
namespace {

using Phase = TipSnapshot::Phase;

// One number of a snapshot, set to any value.
struct Field {
  std::string name;
  std::function<void(Snapshot&, double)> set;
};

void assign(double& number, double x) { number = x; }
void assign(std::uint64_t& number, double x) {
  number = x >= 0.0 && x < 0x1p64 ? static_cast<std::uint64_t>(x) : ~std::uint64_t{0};
}
void assign(std::int64_t& number, double x) {
  number = std::abs(x) < 0x1p63 ? static_cast<std::int64_t>(x) : INT64_MIN;
}

template <class Set>
void set_sums(Snapshot& s, const Set& set) {
  FrictionSums sums = s.friction.sums();
  set(sums);
  s.friction = Friction(sums);
}

// clang-format off
#define AFM_FIELD(number) {#number, [](Snapshot& s, double x) { assign(s.number, x); }}
#define AFM_SUM(number) \
  {"friction." #number, [](Snapshot& s, double x) { set_sums(s, [x](FrictionSums& f) { assign(f.number, x); }); }}

std::vector<Field> fields() {
  return {
      AFM_FIELD(settings.model.gamma), AFM_FIELD(settings.model.v_c), AFM_FIELD(settings.model.y0),
      AFM_FIELD(settings.model.H), AFM_FIELD(settings.model.frequency_ratio), AFM_FIELD(settings.eta),
      AFM_FIELD(settings.contact_tolerance),
      {"sample_period", [](Snapshot& s, double x) { s.settings.sample_period = s.samples.period = x; }},
      AFM_FIELD(settings.samples_per_batch), AFM_FIELD(settings.impact_budget),
      {"friction_window", [](Snapshot& s, double x) {
         s.settings.friction_window = x;
         set_sums(s, [x](FrictionSums& f) { f.window = PowerWindow(f.window_tau = x); });
       }},
      AFM_FIELD(settings.bath.temperature), AFM_FIELD(settings.bath.quality_factor),
      AFM_FIELD(settings.bath.lateral_quality_factor), AFM_FIELD(settings.bath.kicks_per_tau),
      AFM_FIELD(settings.initial.phase), AFM_FIELD(settings.initial.y),
      {"tip.phase", [](Snapshot& s, double x) {
         std::uint64_t phase = 0;
         assign(phase, x);
         s.tip.phase = static_cast<Phase>(phase % 6);
       }},
      AFM_FIELD(tip.time.tau), AFM_FIELD(tip.time.phase), AFM_FIELD(tip.state.phase), AFM_FIELD(tip.state.X),
      AFM_FIELD(tip.state.u), AFM_FIELD(tip.state.g), AFM_FIELD(tip.state.g1), AFM_FIELD(tip.sequence_normal_speed),
      AFM_FIELD(tip.sequence_gain), AFM_FIELD(tip.chatter_speed), AFM_FIELD(tip.chatter_count),
      AFM_FIELD(samples.period), AFM_FIELD(samples.first), AFM_FIELD(samples.origin.tau),
      AFM_FIELD(samples.origin.phase), AFM_FIELD(next_sample), AFM_FIELD(next_impact), AFM_FIELD(kicks.period),
      AFM_FIELD(kicks.first), AFM_FIELD(kicks.origin.tau), AFM_FIELD(kicks.origin.phase), AFM_FIELD(kick_count),
      AFM_FIELD(holder.since.tau), AFM_FIELD(holder.since.phase), AFM_FIELD(holder.from),
      AFM_SUM(window_tau), AFM_SUM(eta), AFM_SUM(start.phase), AFM_SUM(window_start.phase), AFM_SUM(energy.value),
      AFM_SUM(impulse.rest), AFM_SUM(heat.value), AFM_SUM(vertical.value), AFM_SUM(energy_bins.width),
      AFM_SUM(energy_bins.amount[3]), AFM_SUM(impulse_bins.width), AFM_SUM(impulse_bins.amount[63]),
      AFM_SUM(window.width), AFM_SUM(window.energy[32]), AFM_SUM(start.tau), AFM_SUM(window_start.tau),
      AFM_SUM(window.current)};
}
// clang-format on

// A snapshot of each phase, at about 100 tau.
std::vector<Snapshot> snapshots_of_each_phase() {
  std::vector<Snapshot> found;
  Chance chance(15);
  for (const Scene& scene :
       {Scene{5.0, 0.01, 1e-3, ModelKind::oscillator, 0.0}, Scene{0.3, 0.02, 1e-3, ModelKind::oscillator, 1e-3},
        Scene{3.0, 0.02, 1e-3, ModelKind::hammer, 0.0}}) {
    RunSettings settings = settings_of(scene);
    settings.impact_budget = 200;
    afm::Run run(settings);
    Batch batch;
    while (run.now() < ModelTime{100, 0.0}) run.advance(batch);
    for (const Phase phase : {Phase::flight, Phase::contact, Phase::chatter, Phase::touching}) {
      for (int i = 0; i < 1000; ++i) {
        if (i % 2 == 0) chance.advance(run, batch);
        if (i % 2 == 1) seek(i % 4 == 1 ? ImpactKind::burst : ImpactKind::contact_begun, chance, run);
        if (!run.can_split()) continue;
        const Snapshot snapshot = run.split();
        if (snapshot.tip.phase != phase) continue;
        found.push_back(snapshot);
        break;
      }
    }
  }
  return found;
}

enum class Fate { refused, ran };

Fate try_to_run(const Snapshot& snapshot, const std::string& what) {
  std::vector<afm::Run> run;
  try {
    run.emplace_back(snapshot);
  } catch (const ParameterError& fault) {
    EXPECT_FALSE(fault.name.empty());
    return Fate::refused;
  }
  Batch batch;
  for (int i = 0; i < 3; ++i) {
    run[0].advance(batch);
    EXPECT_TRUE(batch.begin <= batch.end) << what;
    EXPECT_LE(batch.impacts.size(), snapshot.settings.impact_budget) << what;
    EXPECT_LE(batch.vertical.size(), snapshot.settings.samples_per_batch) << what;
  }
  return Fate::ran;
}

// A batch of a huge number of samples or impacts is no fault; it is too long for a test.
bool is_long(const Snapshot& s) {
  return s.settings.samples_per_batch > 1000 || s.settings.impact_budget > 1000 || s.settings.sample_period > 1.0;
}

TEST(AlteredSnapshot, IsRefusedByNameOrRunsAndEnds) {
  const double inf = std::numeric_limits<double>::infinity(), nan = std::numeric_limits<double>::quiet_NaN();
  const std::vector<Snapshot> snapshots = snapshots_of_each_phase();
  std::map<Phase, int> phases;
  for (const Snapshot& snapshot : snapshots) ++phases[snapshot.tip.phase];
  ASSERT_EQ(phases.size(), 4u);
  for (const Field& field : fields()) {
    std::map<Fate, int> fates;
    for (const Snapshot& snapshot : snapshots) {
      for (const double x : {nan, inf,  -inf, -1.0, -0.25, -1e-300, 0.0,    1e-300, 1e-9,   0.25,   1.0,
                             2.0, 50.0, 1e3,  1e6,  1e9,   0x1p53,  0x1p59, 0x1p60, 0x1p62, 0x1p63, 1e300}) {
        Snapshot altered = snapshot;
        field.set(altered, x);
        if (is_long(altered)) {
          find_faults(altered);
          continue;
        }
        ++fates[try_to_run(altered, field.name + " = " + std::to_string(x))];
      }
    }
    EXPECT_GT(fates[Fate::refused] + (field.name == "next_impact" ? 1 : 0), 0) << field.name;
  }
}

// The limits of find_faults() are beyond every run.
TEST(Snapshot, OfTheWildestRunsHasNoFault) {
  Chance chance(17);
  Batch batch;
  for (int i = 0; i < 200; ++i) {
    RunSettings settings;
    settings.model.frequency_ratio = chance.one_in(2.0) ? 0.1 : 100.0;
    settings.model.kind = chance.one_in(3.0) ? ModelKind::hammer : ModelKind::oscillator;
    settings.model.gamma = 1.0;
    settings.eta = settings.initial.w = kMaxEta;
    settings.initial.u = -kMaxEta;
    settings.initial.X = 10.0;
    settings.initial.y = chance.within(1.0, 100.0);
    if (chance.one_in(4.0)) settings.model.frequency_ratio = kMinFrequencyRatio, settings.model.y0 = -1e5;
    settings.bath.temperature = kMaxTemperature;
    settings.bath.quality_factor = chance.one_in(2.0) ? 0.0 : kMinQualityFactor;
    settings.sample_period = 0.01;
    settings.samples_per_batch = 100;
    settings.impact_budget = 200;
    ASSERT_TRUE(find_faults(settings).empty()) << find_faults(settings).front().what();
    afm::Run run(settings);
    for (int batches = 0; batches < 20; ++batches) {
      run.advance(batch);
      drag(run, chance.one_in(2.0) ? kMaxEta : -kMaxEta);
      if (!run.can_split()) continue;
      const auto faults = find_faults(run.split());
      ASSERT_TRUE(faults.empty()) << faults.front().what();
    }
  }
}

}  // namespace
}  // namespace afm
