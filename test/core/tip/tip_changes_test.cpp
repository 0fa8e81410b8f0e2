// Restitution, cutoff, rest height, drag velocity and the level of the model changed in mid-flight, in a burst, in
// contact: the tip goes on where it was, and no energy gets lost unseen.
#include <gtest/gtest.h>

#include <cmath>

#include "core/run/interruptible_advance.h"
#include "support/models.h"
#include "trials/energy_balance.h"
#include "trials/random_launches.h"

namespace afm {
namespace {

Model random_model(RandomLaunches& random, double v_c) {
  Model model;
  model.gamma = random.within(0.05, 0.95);
  model.v_c = v_c * random.within(0.5, 2.0);
  model.y0 = random.within(-0.3, 0.09);
  return model;
}

TEST(SetParameters, InFlightTheTipIsAsIfLaunchedThere) {
  RandomLaunches random(7);
  Tip tip(Model{}, 3.4, start_at(3.4));
  int flights = 0;
  for (int i = 0; i < 2000; ++i) {
    detail::bring_to(tip, tip.now() + random.within(0.0, 0.7));
    const TipState state = tip.tip_state();
    if (!(state.g > 0.0)) continue;
    const Model model = random_model(random, 0.05);
    tip.set_parameters(model);
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

// Its event once had the energy that the holder gave or took as well, and so less than none. It is where the last of
// its bounces is, made one by one.
TEST(Drag, AHammerThatIsStoppedInChatterHasLostWhatItsImpactsTook) {
  Model model = hammer(1.0, 0.0);
  model.y0 = -0.5;
  int stopped = 0;
  for (int i = 1; i <= 50; ++i) {
    Tip tip(model, 3.0, TipState{0.02 * i, 0.0, 3.0, 0.0, 1e-3});
    detail::bring_to(tip, {0, 0.005});
    if (!tip.in_chatter()) continue;
    tip.drag(0.0);
    ASSERT_EQ(tip.advance(tip.now()), Outcome::impact);
    ASSERT_EQ(tip.last_impact().kind, ImpactKind::burst);
    EXPECT_NEAR(tip.last_impact().energy_loss, 0.0, 1e-18) << i;
    Tip bounces(model, 3.0, TipState{0.02 * i, 0.0, 3.0, 0.0, 1e-3}, 0.0);
    detail::bring_to(bounces, {0, 0.005});
    EXPECT_NEAR(tip.last_impact().surface_phase, bounces.last_impact().surface_phase, 1e-6) << i;
    ++stopped;
  }
  EXPECT_GT(stopped, 10);
}

// A sequence that never dies, as gamma = 1 and a load holds the tip down: its count once wrapped at a command.
TEST(Drag, ACountOfMoreBouncesThanAnEventCanHaveStaysAtThat) {
  constexpr double kMost = 4294967295.0;
  Model model = model_with(1.0, 0.0);
  model.y0 = -0.5;
  Tip tip(model, 0.2, TipState{0.5, 0.0, 0.2, 0.0, 2e-5});
  double count = 0.0;
  Segments ended;
  for (const double eta : {0.1, 0.2}) {
    const ModelTime limit = tip.now() + 20000.0;
    while (tip.advance_segment(limit, &ended) != Outcome::time_limit) {
      for (const Segment& segment : ended) count += static_cast<double>(segment.count);
    }
    EXPECT_TRUE(tip.in_chatter());
    count += static_cast<double>(tip.segment().count);
    EXPECT_EQ(count, kMost);
    tip.drag(eta);
  }
}

TEST(SetParameters, KeepsTheHammerAboveTheSurface) {
  RandomLaunches random(9);
  Tip tip(hammer(0.7, 0.005), 0.5, start_at(0.5));
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
    tip.set_parameters(model);
    ASSERT_NEAR(tip.state().y, before.y, 1e-5);
    ASSERT_EQ(tip.state().X, 0.0);
    ASSERT_GE(tip.deflection(tip.now()).gap, -1e-13);
  }
  EXPECT_GT(contacts, 20);
}

// After a drag of the hammer in contact, and a change at the same time.
template <class Change>
void expect_the_tip_under_its_holder(const Change& change) {
  for (const double eta : {3.4, 0.2, -0.2, 1e-3}) {
    Model model = hammer(0.7, 0.05);
    model.y0 = -1.0;
    constexpr double kPhase = 0.3;  // on a slope: one way it lifts off, the other way it has an impact
    Tip tip(model, 0.0, FreeState{kPhase, 0.0, model.H * std::cos(kTwoPi * kPhase), 0.0, 0.0});
    detail::bring_to(tip, {2, 0.0});
    ASSERT_TRUE(tip.in_contact());
    EnergyBalance balance(tip);
    balance.command(tip, [&] { tip.drag(eta); });
    balance.command(tip, [&] { change(tip); });
    while (tip.now() < ModelTime{22, 0.0}) balance.advance_segment(tip, {22, 0.0});
    const FreeState state = tip.state();
    EXPECT_EQ(state.X, 0.0);
    EXPECT_EQ(state.u, eta);
    EXPECT_NEAR(std::remainder(state.phase - (kPhase + 20.0 * eta), 1.0), 0.0, 1e-12);
    EXPECT_LT(balance.imbalance(tip), 1e-12 * balance.turnover(tip));
  }
}

// Once the tip forgot the drag, and was dragged behind a holder that left it.
TEST(SetParameters, BehindADragOfAHammerInContactLeavesTheTipUnderItsHolder) {
  expect_the_tip_under_its_holder([](Tip& tip) {
    Model model = tip.model();
    model.gamma = 0.6;
    tip.set_parameters(model);
  });
}
TEST(SetModel, BehindADragOfAHammerInContactLeavesTheTipUnderItsHolder) {
  expect_the_tip_under_its_holder([](Tip& tip) { tip.set_model(ModelKind::hammer, 1e-4); });
}

// Lifted off and put back before any time has passed, it lies on.
TEST(SetParameters, TakenBackAtOneTimeAreNoEvent) {
  for (const ModelKind kind : {ModelKind::oscillator, ModelKind::hammer}) {
    Model low;
    low.kind = kind;
    low.y0 = -1.0;
    Model high = low;
    high.y0 = 0.09;
    Tip tip(low, 0.0, FreeState{0.5, 0.0, -low.H, 0.0, 0.0});
    detail::bring_to(tip, {2, 0.0});
    tip.set_parameters(high);
    tip.set_parameters(low);
    EXPECT_TRUE(tip.is_settled());
    EXPECT_EQ(tip.advance({4, 0.0}), Outcome::time_limit);
  }
}

TEST(SetParameters, AndSetBathToTheSameChangeNoBit) {
  for (const double quality_factor : {0.0, 100.0}) {
    Bath bath;
    bath.quality_factor = quality_factor;
    Tip plain(Model{}, 2.0, start_at(2.0));
    plain.set_bath(bath);
    Tip commanded = plain;
    for (int i = 1; i <= 20; ++i) {
      const ModelTime next = multiply(static_cast<std::uint64_t>(i), 1.5);
      detail::bring_to(plain, next);
      detail::bring_to(commanded, next);
      commanded.set_parameters(commanded.model());
      commanded.set_bath(bath);
      ASSERT_EQ(commanded.tip_state().phase, plain.tip_state().phase) << i;
      ASSERT_EQ(commanded.tip_state().g1, plain.tip_state().g1) << i;
    }
  }
}

constexpr double kTolerances[] = {0.0, 1e-5, 1e-4, 1e-3, 1e-2};

struct Run {
  double eta, v_c;
};

class Changes : public testing::TestWithParam<Run> {
 protected:
  // Changes at random times, whatever the tip is at: flight, burst, contact. In a burst the tip is where its bounces
  // are, not on its reference slide: beside it by less than the contact tolerance.
  template <class Change>
  void expect_balance(RandomLaunches& random, double beside, const Change& change) {
    Tip tip(model_with_cutoff(GetParam().v_c), GetParam().eta, start_at(GetParam().eta));
    EnergyBalance balance(tip);
    int bursts = 0, contacts = 0;
    for (int changes = 0; changes < 3000; ++changes) {
      const ModelTime next = tip.now() + random.within(0.0, 1.0);
      for (int segments = 0; tip.now() < next && segments < 500; ++segments) {
        ASSERT_NE(balance.advance_segment(tip, next), Outcome::search_failed);
      }
      bursts += tip.in_chatter();
      contacts += tip.in_contact();
      const FreeState before = tip.state();
      const double near = tip.tip_state().g > 0.0 || tip.in_contact() ? 1e-14 : beside;
      balance.command(tip, [&] { change(tip); });
      ASSERT_NEAR(tip.state().y, before.y, near);
      ASSERT_NEAR(tip.state().X, before.X, near);
      ASSERT_NEAR(tip.state().u, before.u, 1e3 * near * (std::abs(before.u) + 1.0));
      ASSERT_LT(balance.imbalance(tip), 1e-12 * balance.turnover(tip)) << changes;
    }
    EXPECT_GT(balance.lost(), 0.0);
    if (GetParam().v_c < 0.004) {  // elsewhere it is rarely caught in a burst
      EXPECT_GT(bursts + contacts, 20);
    }
  }
};

TEST_P(Changes, OfParametersConserveEnergy) {
  RandomLaunches random(11);
  expect_balance(random, 1e-5, [&](Tip& tip) { tip.set_parameters(random_model(random, GetParam().v_c)); });
}

// The velocity in the lab stays, and so does the energy.
TEST_P(Changes, OfDragVelocityConserveEnergy) {
  RandomLaunches random(4);
  expect_balance(random, 1e-5, [&](Tip& tip) {
    const double energy = tip.stored_energy();
    tip.drag(GetParam().eta * random.within(0.8, 1.2));
    ASSERT_NEAR(tip.stored_energy(), energy, 1e-13 * (1.0 + energy));
  });
}

TEST_P(Changes, OfToleranceConserveEnergy) {
  RandomLaunches random(3);
  expect_balance(random, 1e-4, [&](Tip& tip) {
    const double tolerance = kTolerances[static_cast<std::size_t>(random.within(0.0, 4.999))];
    ASSERT_EQ(tip.set_model(ModelKind::oscillator, tolerance), 0.0);
  });
}

// What is dropped on the way to the hammer is what is missing; on the way back nothing is.
TEST_P(Changes, ToAnotherModelDropWhatTheySay) {
  RandomLaunches random(5);
  const double eta = GetParam().eta;
  const Model model = model_with_cutoff(GetParam().v_c);
  Tip tip(model, eta, start_at(eta));
  int contacts = 0;
  double dropped = 0.0;
  for (int changes = 0; changes < 3000; ++changes) {
    const bool to_hammer = changes % 2 == 0;
    const ModelTime next = tip.now() + random.within(0.0, 2.0);
    for (int events = 0; events < 2000 && tip.advance(next) != Outcome::time_limit; ++events) {
    }
    contacts += tip.in_contact();
    const bool free = tip.tip_state().g > 0.0;
    const FreeState before = tip.state();
    const double drop = tip.set_model(to_hammer ? ModelKind::hammer : ModelKind::oscillator, kDefaultContactTolerance);
    const FreeState after = tip.state();
    const double scale = stored_energy(model, before) + 0.5 * eta * eta;
    if (free) {
      ASSERT_NEAR(stored_energy(model, before) - stored_energy(model, after), drop, 1e-13 * scale);
      ASSERT_EQ(after.phase, before.phase);
      ASSERT_NEAR(after.y, before.y, 1e-15);
      ASSERT_NEAR(after.w, before.w, 1e-14 * (1.0 + std::abs(eta)));
    }
    if (to_hammer) {
      ASSERT_EQ(after.X, 0.0);
      ASSERT_EQ(after.u, eta);
      dropped += drop;
    } else {
      ASSERT_EQ(drop, 0.0);
    }
    ASSERT_GE(tip.deflection(tip.now()).gap, -1e-13);
  }
  EXPECT_NE(dropped, 0.0);
  if (GetParam().v_c < 0.01) {
    EXPECT_GT(contacts, GetParam().v_c < 0.004 ? 20 : 0);
  }
}

// A change of level that ends a burst or a contact tells of it, once, at its time; commands at the same time lose
// nothing.
TEST_P(Changes, OfLevelTellEventsOnce) {
  RandomLaunches random(8);
  const double eta = GetParam().eta;
  Tip tip(model_with_cutoff(GetParam().v_c), eta, start_at(eta));
  int begun = 0, ended = 0;
  const auto book = [&](Outcome outcome) {
    if (outcome == Outcome::contact) ++begun;
    if (outcome == Outcome::released) ++ended;
  };
  for (int changes = 0; changes < 3000; ++changes) {
    const ModelTime next = tip.now() + random.within(0.0, 1.0);
    Outcome outcome = Outcome::flying;
    for (int events = 0; events < 2000 && outcome != Outcome::time_limit; ++events) book(outcome = tip.advance(next));
    tip.set_model(changes % 2 == 0 ? ModelKind::hammer : ModelKind::oscillator, kTolerances[1 + changes % 4]);
    if (changes % 3 == 0) tip.drag(eta * random.within(0.5, 1.5));
    if (changes % 5 == 0) tip.set_model(ModelKind::oscillator, 1e-3);
    ASSERT_EQ(begun - ended, tip.in_contact() ? 1 : begun - ended);
    ASSERT_GE(begun, ended);
    ASSERT_LE(begun, ended + 1);
  }
  if (GetParam().v_c < 0.01) {
    EXPECT_GT(begun, GetParam().v_c < 0.004 ? 20 : 0);
  }
}

INSTANTIATE_TEST_SUITE_P(Runs, Changes,
                         testing::Values(Run{3.4, 0.3}, Run{0.5, 0.005}, Run{-0.2, 0.002}, Run{3.0, 0.03}));

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
  tip.advance(tip.now() + random.within(0.0, 0.999) * (tip.segment_end() - tip.now()));
}

TEST(SetParameters, InContactItGoesOnExactlyWhereTheSurfaceStillPresses) {
  RandomLaunches random(3);
  int stayed = 0, left = 0;
  while (stayed + left < 2000) {
    Tip tip = slow_bounce(random, model_with_cutoff(0.005), 0.5);
    const ModelTime patience = tip.now() + 1.0;
    for (Outcome o = Outcome::flying; o != Outcome::contact && o != Outcome::time_limit;) o = tip.advance(patience);
    if (!tip.in_contact()) continue;
    advance_within_arc(random, tip);
    Tip changed = tip;
    const Model model = random_model(random, 0.005);
    changed.set_parameters(model);
    const double pull = Flight<double>(SpringConstants<double>(model), tip.eta(), tip.tip_state()).start().g2;
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

// It is rising or falling there, each half of the time.
TEST(SetParameters, ABurstEndsInTheFlightAfterItsLastBounce) {
  RandomLaunches random(5);
  int chattering = 0, bursts = 0, rising = 0;
  while (chattering < 1000) {
    Tip tip = slow_bounce(random, model_with_cutoff(0.005), 0.5);
    if (!is_bursting(tip)) continue;
    ++chattering;
    advance_within_arc(random, tip);
    Tip changed = tip;
    changed.set_parameters(random_model(random, 0.005));
    ASSERT_TRUE(changed.in_flight());
    ASSERT_GE(changed.tip_state().g, 0.0);
    rising += changed.tip_state().g1 > 0.0;
    const Outcome outcome = changed.advance(tip.now());
    ASSERT_TRUE(changed.now() == tip.now());
    if (outcome == Outcome::time_limit) continue;  // no bounce has ended yet
    ASSERT_EQ(outcome, Outcome::impact);
    ASSERT_EQ(changed.last_impact().kind, ImpactKind::burst);
    ++bursts;
  }
  EXPECT_GT(bursts, 500);
  EXPECT_NEAR(rising, 500, 100);
}

}  // namespace
}  // namespace afm
