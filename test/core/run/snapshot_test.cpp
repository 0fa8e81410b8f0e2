// A snapshot splits a run: the run goes on with the bits of one that is made from it. The split changes the motion by
// rounding and leaves the energy balance closed.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>
#include <vector>

#include "afm/detail/chatter.h"
#include "support/random_runs.h"
#include "support/recorded_run.h"
#include "trials/energy_balance.h"

namespace afm {
namespace {

using Phase = TipSnapshot::Phase;

void expect_same(const Batch& a, const Batch& b) {
  static_assert(sizeof(FrictionEstimate) % 8 == 0);  // doubles and a number, without padding
  ASSERT_TRUE(a.begin == b.begin && a.end == b.end && a.first_sample_time == b.first_sample_time);
  ASSERT_EQ(a.first_sample, b.first_sample);
  ASSERT_EQ(a.first_impact, b.first_impact);
  ASSERT_EQ(a.impact_limit, b.impact_limit);
  ASSERT_EQ(a.eta, b.eta);
  ASSERT_EQ(a.holder, b.holder);
  ASSERT_EQ(a.vertical, b.vertical);
  ASSERT_EQ(a.lateral, b.lateral);
  ASSERT_EQ(a.impacts.size(), b.impacts.size());
  for (std::size_t i = 0; i < a.impacts.size(); ++i) ASSERT_TRUE(same_bits(a.impacts[i], b.impacts[i]));
  ASSERT_EQ(std::memcmp(&a.friction, &b.friction, sizeof a.friction), 0);
}

class Snapshots : public testing::TestWithParam<Scene> {
 protected:
  bool has_contact() const { return GetParam().contact_tolerance > 0.0 && std::abs(GetParam().eta) < 6.0; }
};

TEST_P(Snapshots, TheRunGoesOnAsOneMadeFromIt) {
  Chance chance(11);
  std::map<Phase, int> phases;
  int with_pending_event = 0;
  Batch a, b;
  for (int starts = 0; starts < 30; ++starts) {
    afm::Run run(settings_of(GetParam()));
    advance_to(run.now() + chance.within(0.0, 1.0), run, a);
    for (int splits = 0; splits < 50; ++splits) {
      for (int i = 0; i < 4; ++i) {
        const Outcome outcome = chance.advance(run, a);
        ASSERT_TRUE(outcome == Outcome::budget_spent || run.can_split());
      }
      if (splits % 2 == 0) run.apply(chance.command(run));
      if (splits % 4 == 1) seek(chance.one_in(2.0) ? ImpactKind::burst : ImpactKind::contact_begun, chance, run);
      if (!run.can_split()) {
        ++with_pending_event;  // of the command
        continue;
      }
      const Snapshot snapshot = run.split();
      ++phases[snapshot.tip.phase];
      ASSERT_TRUE(find_faults(snapshot).empty()) << find_faults(snapshot).front().what();
      afm::Run again(snapshot);
      for (int i = 0; i < 4; ++i) {
        run.advance(a);
        again.advance(b);
        ASSERT_NO_FATAL_FAILURE(expect_same(a, b)) << "start " << starts << ", split " << splits;
        const RunSettings live = chance.command(run);
        ASSERT_EQ(run.apply(live), again.apply(live));
      }
      ASSERT_TRUE(again.now() == run.now());
      ASSERT_EQ(again.samples(), run.samples());
    }
  }
  EXPECT_GT(phases[Phase::flight], 150);
  if (has_contact()) {
    for (const Phase phase : {Phase::contact, Phase::chatter, Phase::touching}) EXPECT_GT(phases[phase], 0);
  }
  EXPECT_LT(with_pending_event, 300);
}

double event_distance(const Impact& a, const Impact& b) {
  return std::max({std::abs(a.time - b.time), std::abs(std::remainder(a.surface_phase - b.surface_phase, 1.0)),
                   std::abs(a.normal_speed - b.normal_speed), std::abs(a.tangential_velocity - b.tangential_velocity),
                   std::abs(a.energy_loss - b.energy_loss)});
}

// The next event of at least this speed, over batch boundaries.
Impact next_event(double slowest, afm::Run& run) {
  Batch batch;
  for (int i = 0; i < 10000; ++i) {
    advance_impacts(1, run, batch);
    if (batch.impacts.empty()) continue;
    const Impact& event = batch.impacts.front();
    if (slowest == 0.0 || (event.kind == ImpactKind::impact && event.normal_speed >= slowest)) return event;
  }
  return {};
}

// A flight by rounding, contact and chatter within their tolerance. A kick of the bath meets a tip that chatters within
// its bounce, where two sequences may differ by all of it.
TEST_P(Snapshots, ChangeTheNextEventLittle) {
  Chance chance(12);
  RunSettings settings = settings_of(GetParam());
  afm::Run run(settings);
  std::map<Phase, std::vector<double>> off;
  Batch a, b;
  for (int i = 0; i < 1000; ++i) {
    chance.advance(run, a);
    if (i % 3 == 0) seek(i % 2 == 0 ? ImpactKind::burst : ImpactKind::contact_ended, chance, run);
    if (!run.can_split()) continue;
    afm::Run split = run;
    const Snapshot snapshot = split.split();
    afm::Run whole = run;
    const double slowest = snapshot.tip.phase == Phase::chatter ? 0.1 * std::min(1.0, std::abs(GetParam().eta)) : 0.0;
    const Impact expected = next_event(slowest, whole), found = next_event(0.99 * slowest, split);
    off[snapshot.tip.phase].push_back(expected.kind == found.kind ? event_distance(expected, found) : 1.0);
  }
  for (auto& phase : off) {
    std::vector<double>& distances = phase.second;
    std::sort(distances.begin(), distances.end());
    if (phase.first == Phase::flight || phase.first == Phase::touching) {
      EXPECT_LE(distances.back(), 1e-12) << static_cast<int>(phase.first);
    } else if (distances.size() >= 20) {  // the few that meet a crest differently are further off than any bound
      // in chatter as in docs/stability.md
      const bool chatters = phase.first == Phase::chatter;
      const double typical = distances[distances.size() / 2], most = distances[distances.size() * 95 / 100];
      if (chatters && settings.bath.is_on()) {
        EXPECT_LE(typical, GetParam().contact_tolerance);
        EXPECT_LE(most, 2.0 * detail::chatter_entry_speed(GetParam().contact_tolerance));
      } else {
        EXPECT_LE(typical, chatters ? 4e-6 : GetParam().contact_tolerance);
        EXPECT_LE(most, chatters ? 2e-4 : GetParam().contact_tolerance);
      }
    }
  }
}

TEST(Snapshot, InAChatterSequenceKeepsTheSpeedOfItsFirstBounce) {
  constexpr double kSpeed = 1e-3;
  for (const ModelKind kind : {ModelKind::oscillator, ModelKind::hammer}) {
    Model model;
    model.kind = kind;
    model.y0 = -0.5;
    Tip tip(model, 0.3, TipState{0.5, 0.0, 0.3, 0.0, kSpeed});  // in a valley: the gap rate is the normal speed
    tip.advance({0, 1e-3});
    ASSERT_TRUE(tip.in_chatter());
    Tip again(model, 0.3, tip.snapshot(), kDefaultContactTolerance, tip.thermostat());
    ASSERT_EQ(again.advance(kEndOfTime), Outcome::impact);
    ASSERT_EQ(again.last_impact().kind, ImpactKind::burst);
    EXPECT_DOUBLE_EQ(again.last_impact().normal_speed, kSpeed);
  }
}

// Eq. 1 over splits and without: the work of the drag is what impacts and bath take, and what the tip stores.
TEST_P(Snapshots, LeaveTheEnergyBalanceClosed) {
  if (GetParam().kind == ModelKind::hammer) return;  // the holder also takes energy across its constraint
  Chance chance(13);
  afm::Run run(settings_of(GetParam()));
  Batch batch;
  const double stored = stored_energy(run.settings().model, run.state());
  for (int i = 0; i < 1000; ++i) {
    chance.advance(run, batch);
    if (i % 5 == 0) seek(chance.one_in(2.0) ? ImpactKind::burst : ImpactKind::contact_ended, chance, run);
    if (run.can_split()) run.split();
  }
  // in a chatter sequence the state is that of the reference slide
  while (run.split().tip.phase == Phase::chatter) advance_impacts(1, run, batch);
  advance_to(run.now(), run, batch);
  const double work = run.eta() * batch.friction.mean_lateral_force * (run.now() - ModelTime{});
  const double change = stored_energy(run.settings().model, run.state()) - stored;
  const double spent = batch.friction.energy_loss + batch.friction.heat_to_bath + change;
  EXPECT_NEAR(work, spent, 2e-13 * (std::abs(work) + batch.friction.energy_loss + std::abs(change)));
  EXPECT_GT(run.now() - ModelTime{}, 10.0);
}

// Of the flight or contact under way nothing is lost or counted twice.
TEST_P(Snapshots, LeaveTheSumsOfTheFrictionAsTheyAre) {
  Chance chance(14);
  afm::Run run(settings_of(GetParam()));
  Batch a, b;
  for (int i = 0; i < 1000; ++i) {
    chance.advance(run, a);
    if (!run.can_split()) continue;
    afm::Run split = run;
    if (split.split().tip.phase == Phase::chatter) continue;  // counts its bounces up to the split
    advance_to(run.now(), run, a);
    advance_to(split.now(), split, b);
    ASSERT_EQ(a.friction.energy_loss, b.friction.energy_loss);
    ASSERT_EQ(a.friction.heat_to_bath, b.friction.heat_to_bath);
    ASSERT_EQ(a.friction.impact_count, b.friction.impact_count);
    const double force = a.friction.mean_lateral_force;
    if (a.end < ModelTime{1, 0.0}) continue;
    ASSERT_NEAR(force, b.friction.mean_lateral_force, 1e-13 * (1.0 + std::abs(force)));
  }
}

INSTANTIATE_TEST_SUITE_P(
    Scenes, Snapshots,
    testing::Values(
        Scene{0.05, 0.005, 0.0, ModelKind::oscillator, 0.0}, Scene{0.05, 0.005, 1e-3, ModelKind::oscillator, 0.0},
        Scene{0.5, 0.05, 1e-3, ModelKind::oscillator, 0.0}, Scene{2.0, 0.05, 0.0, ModelKind::oscillator, 0.0},
        Scene{3.0, 0.02, 1e-3, ModelKind::hammer, 0.0}, Scene{3.4, 0.05, 1e-3, ModelKind::oscillator, 0.0},
        Scene{3.4, 0.05, 1e-3, ModelKind::oscillator, 0.926}, Scene{5.0, 0.01, 1e-3, ModelKind::oscillator, 0.0},
        Scene{0.3, 0.02, 1e-3, ModelKind::oscillator, 1e-3}, Scene{0.5, 0.02, 1e-3, ModelKind::hammer, 0.3},
        Scene{0.3, 0.05, 1e-3, ModelKind::oscillator, 0.926, -1.0},
        Scene{0.3, 0.05, 1e-2, ModelKind::hammer, 0.926, -1.0}, Scene{7.0, 0.7, 1e-3, ModelKind::oscillator, 0.0}));

}  // namespace
}  // namespace afm
