// The hammer (section IX): the tip held along x. Closed forms, commands, and what its bursts lose.
#include <gtest/gtest.h>

#include <cmath>

#include "afm/tip.h"
#include "core/run/interruptible_advance.h"
#include "support/models.h"
#include "trials/random_launches.h"
#include "trials/tip_watch.h"

namespace afm {
namespace {

// At even eta and y0 = 0: two impacts a tau, each on the rising flank at mid-height, with w = s eta (1 + gamma)/(1 -
// gamma) after.
FreeState even_orbit(const Model& model, double eta) {
  const double s = kTwoPi * model.H;
  return {0.75, 0.0, 0.0, eta, s * eta * (1.0 + model.gamma) / (1.0 - model.gamma)};
}

TEST(Hammer, AtEvenEtaItsFrictionIsTheClosedForm) {
  for (const double gamma : {0.3, 0.5, 0.7}) {
    for (const double eta : {2.0, -4.0, 6.0}) {
      const Model model = hammer(gamma);
      FreeState start = even_orbit(model, std::abs(eta));
      start.phase = eta > 0.0 ? 0.75 : 0.25;
      Tip tip(model, eta, start);
      double energy = 0.0;
      for (int i = 0; i < 4; ++i) {
        ASSERT_EQ(tip.advance(kEndOfTime), Outcome::impact);
        energy += tip.last_impact().energy_loss;
      }
      const double s = kTwoPi * model.H, K_f = energy / (eta * eta * (tip.now() - ModelTime{}));
      EXPECT_NEAR(K_f, 4.0 * s * s * (1.0 + gamma) / (1.0 - gamma), 1e-12 * K_f) << gamma << " " << eta;
    }
  }
}

// A command that throws it off the surface comes at a time whose difference from the contact's beginning is rounded.
TEST(Hammer, ThrownOffByACommandItIsThrownThenAndNoUlpSooner) {
  RandomLaunches random(2);
  int thrown = 0;
  for (int i = 0; i < 2000; ++i) {
    Tip tip(hammer(), 0.2, FreeState{random.within(0.2, 0.8), 0.0, 0.2, 0.2, 0.0});
    const ModelTime command{40, random.within(0.0, 0.01)};  // a small phase has digits that the difference has not
    detail::bring_to(tip, command);
    if (!tip.in_contact()) continue;
    tip.drag(3.4);
    ASSERT_NE(tip.advance(kEndOfTime), Outcome::time_limit);
    ASSERT_FALSE(tip.last_impact().time < command);
    ++thrown;
  }
  EXPECT_GT(thrown, 300);
}

// In 2 of 1000 the sum of the contact's beginning and the time since was an ulp later: another command at the same time
// then took the tip for one that rests.
TEST(Hammer, ThrownOffByACommandItLeavesAtOnce) {
  RandomLaunches random(3);
  Model model = hammer();
  model.y0 = -1.0;
  Tip tip(model, 0.0, FreeState{0.5, 0.0, -model.H, 0.0, 0.0});
  for (int i = 0; i < 20000; ++i) {
    const ModelTime command = tip.now() + random.within(0.0, 0.01);
    detail::bring_to(tip, command);
    ASSERT_TRUE(tip.in_contact());
    Tip thrown = tip;
    thrown.drag(3.4);
    ASSERT_FALSE(thrown.is_settled()) << i;
  }
}

// Where the contact begins just before a whole tau, the ulp of the phase is many ulp of the time since.
TEST(Hammer, ThrownOffRightAfterAWholeTauItLeavesAtOnce) {
  RandomLaunches random(5);
  Model model = hammer();
  model.y0 = -1.0;
  for (int i = 0; i < 2000; ++i) {
    const double before = std::pow(10.0, random.within(-9.0, -3.0));
    const Tip resting(model, 0.0, FreeState{0.5, 0.0, -model.H, 0.0, 0.0});
    Tip tip = resting;
    detail::bring_to(tip, {0, 1.0 - before});
    tip.set_model(ModelKind::hammer, 0.5 * kDefaultContactTolerance);  // a new slide begins there
    const ModelTime command{1, random.within(0.0, 1e-12)};
    detail::bring_to(tip, command);
    tip.drag(3.4);
    ASSERT_FALSE(tip.is_settled()) << before;
  }
}

// The second takes back what the first has done, before any time has passed; a blow alone is not taken back.
TEST(Hammer, OfTwoCommandsAtOneTimeTheLastCounts) {
  RandomLaunches random(4);
  int commands = 0;
  for (int i = 0; i < 2000; ++i) {
    TipWatch watch(hammer(), 9.0, FreeState{random.within(0.0, 1.0), 0.0, 0.2, 9.0, 0.0}, kDefaultContactTolerance);
    const ModelTime command{2, random.within(0.0, 1.0)};
    ASSERT_TRUE(watch.advance(command)) << watch.violation();
    if (!watch.tip().in_contact()) continue;
    const bool happens = i % 2 == 0, hits = surface_jet(hammer().H, watch.tip().tip_state().phase).h1 < 0.0;
    watch.drag(-20.0);
    if (happens) {
      ASSERT_TRUE(watch.advance(command)) << watch.violation();
    }
    watch.drag(9.0);
    ASSERT_TRUE(watch.advance(command)) << watch.violation();
    EXPECT_EQ(watch.tip().in_contact(), !(happens && hits)) << watch.violation();
    ASSERT_TRUE(watch.advance(command + 1.0)) << watch.violation();
    ++commands;
  }
  EXPECT_GT(commands, 80);
}

// In the first bounce of the sequence what the record before it had lost was taken back from the next impact: K_f and
// the sum of the recorded impacts differed by 3e-5. Only a burst may have lost a part of its energy before.
TEST(Hammer, AfterACommandInChatterComesItsBurstOrAnImpactThatLosesAllThatIsLost) {
  RandomLaunches random(6);
  int commands = 0;
  for (int i = 0; i < 20000; ++i) {
    Tip tip(hammer(0.7, 1.4), 7.0, TipState{0.3, 0.0, 7.0, 0.0, random.within(0.001, 0.02)});
    const ModelTime command{0, random.within(0.0, 0.1)};
    detail::bring_to(tip, command);
    if (!tip.in_chatter()) continue;
    ++commands;
    tip.drag(random.within(-9.0, 9.0));
    Segments ended;
    double lost = 0.0;
    Outcome outcome = Outcome::flying;
    while (outcome == Outcome::flying) {
      outcome = tip.advance_segment(kEndOfTime, &ended);
      for (const Segment& segment : ended) lost += segment.loss;
    }
    if (outcome == Outcome::released || tip.last_impact().kind != ImpactKind::impact) continue;
    ASSERT_NEAR(lost, tip.last_impact().energy_loss, 1e-13) << i;
  }
  EXPECT_GT(commands, 1000);
}

// Under a holder at rest a sequence that begins below the threshold dies at once. Its event said that it loses nothing.
TEST(Hammer, ABounceBelowTheThresholdLosesAllItsEnergy) {
  Model model = hammer();
  model.y0 = -0.2;        // it is held down in a valley
  const double w = 3e-5;  // of the last bounce; contact is below 1e-4 with this tolerance
  Tip tip(model, 0.0, FreeState{0.5, 0.0, -model.H, 0.0, w}, 1e-2);
  double lost = 0.0;
  while (tip.advance({1, 0.0}) == Outcome::impact) lost += tip.last_impact().energy_loss;
  EXPECT_TRUE(tip.in_contact());
  EXPECT_NEAR(lost, 0.5 * w * w, 1e-9 * lost);
}

// Loss of the chatter in one valley, from its first bounce to the end of the pressure, in how many bursts, and the
// normal speed of the first bounce.
struct Loss {
  double energy, first_speed;
  int bursts;
};
Loss lost_in_a_valley(double gap_rate, double tolerance) {
  Tip tip(hammer(0.7, 1.4), 7.0, TipState{0.3, 0.0, 7.0, 0.0, gap_rate}, tolerance);
  Loss lost{0.0, 0.0, 0};
  const ModelTime end{0, 0.1};
  for (Outcome o = tip.advance(end); o != Outcome::time_limit; o = tip.advance(end)) {
    if (o != Outcome::impact) continue;
    if (lost.energy == 0.0) lost.first_speed = tip.last_impact().normal_speed;
    lost.energy += tip.last_impact().energy_loss;
    if (tip.last_impact().kind == ImpactKind::burst) ++lost.bursts;
  }
  return lost;
}

TEST(Hammer, BurstsLoseWhatTheirBouncesLoseAndAreAsFastAsTheFirst) {
  for (const double gap_rate : {0.002, 0.005, 0.01, 0.02}) {
    const Loss bounces = lost_in_a_valley(gap_rate, 0.0);
    const double tolerance = gap_rate > 0.01 ? kMaxContactTolerance : kDefaultContactTolerance;
    const Loss burst = lost_in_a_valley(gap_rate, tolerance);
    ASSERT_EQ(bounces.bursts, 0);
    EXPECT_GT(burst.bursts, 0) << gap_rate;
    EXPECT_NEAR(burst.energy, bounces.energy, 1e-4 * bounces.energy) << gap_rate;
    EXPECT_NEAR(burst.first_speed, bounces.first_speed, 0.02 * gap_rate) << gap_rate;
  }
}

TEST(Hammer, AtRestItsImpactsLoseWhatItHasStored) {
  for (const double phase : {0.1, 0.2, 0.85}) {  // where the surface presses
    Tip tip(hammer(), 0.0, FreeState{phase, 0.0, 0.2, 0.0, 0.0});
    const double stored = tip.stored_energy();
    double lost = 0.0;
    while (tip.advance(kEndOfTime) == Outcome::impact) lost += tip.last_impact().energy_loss;
    ASSERT_TRUE(tip.in_contact());
    EXPECT_EQ(tip.last_impact().kind, ImpactKind::contact_begun);
    EXPECT_NEAR(lost, stored - tip.stored_energy(), 1e-14) << phase;
  }
}

}  // namespace
}  // namespace afm
