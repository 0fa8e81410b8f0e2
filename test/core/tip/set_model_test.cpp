// The level of the model changed in mid-run: the tip goes on where it was, and no energy gets lost unseen.
#include <gtest/gtest.h>

#include <cmath>

#include "support/models.h"
#include "trials/energy_balance.h"
#include "trials/random_launches.h"

namespace afm {
namespace {

constexpr double kTolerances[] = {0.0, 1e-5, 1e-4, 1e-3, 1e-2};

struct Run {
  double eta, v_c;
};
class SetModelAt : public testing::TestWithParam<Run> {};

// What is dropped on the way to the hammer is what is missing; on the way back nothing is.
TEST_P(SetModelAt, AnotherModelDropsWhatItSays) {
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
TEST_P(SetModelAt, EventsAreToldOnce) {
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

INSTANTIATE_TEST_SUITE_P(Runs, SetModelAt,
                         testing::Values(Run{3.4, 0.3}, Run{0.5, 0.005}, Run{-0.2, 0.002}, Run{3.0, 0.03}));

}  // namespace
}  // namespace afm
