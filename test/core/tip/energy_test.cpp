// The drag works only through the springs: what is lost in impacts is what it put in, less what is stored.
#include <gtest/gtest.h>

#include <cmath>

#include "trials/energy_balance.h"

namespace afm {
namespace {

constexpr double kEveryBounce = 0.0;  // contact tolerance

struct Balance {
  double work, lost, stored;
};

Balance run(const Model& model, double eta, int impacts) {
  Tip tip(model, eta, FreeState{0.25, 0.0, 0.2, eta, 0.0}, kEveryBounce);
  const double before = stored_energy(model, tip.state());
  long double work = 0.0L, lost = 0.0L;
  for (int i = 0; i < impacts;) {
    const double u = tip.state().u;
    if (tip.advance(kEndOfTime) != Outcome::impact) continue;
    ++i;
    // the work on the springs in a flight: eta times the force, which is the change of u
    work += eta * (incident_u(model, tip.last_impact()) - u);
    lost += tip.last_impact().energy_loss;
  }
  return {static_cast<double>(work), static_cast<double>(lost), stored_energy(model, tip.state()) - before};
}

class EnergyAtEta : public testing::TestWithParam<double> {};

TEST_P(EnergyAtEta, WhatIsLostIsTheWorkOfTheDragLessWhatIsStored) {
  Model model;
  model.v_c = 0.1 * std::abs(GetParam());
  const Balance balance = run(model, GetParam(), 100000);
  EXPECT_NEAR(balance.lost, balance.work - balance.stored, 1e-12 * balance.lost);
  EXPECT_GT(balance.lost, 0.0);
}

INSTANTIATE_TEST_SUITE_P(DragSpeeds, EnergyAtEta, testing::Values(0.5, 1.5, 2.0, 2.75, 3.4, -3.4, 5.0, 8.0));

// What an elastic tip at rest gains in a million impacts, as a part of its energy.
double drift_at_rest(double phase, double velocity) {
  Model model;
  model.gamma = 1.0;
  Tip tip(model, 0.0, FreeState{phase, 0.03, 0.2, velocity, 0.0}, kEveryBounce);
  const double energy = stored_energy(model, tip.state());
  for (int impacts = 0; impacts < 1000000; ++impacts) {
    EXPECT_EQ(tip.advance(kEndOfTime), Outcome::impact);
    if (tip.last_impact().energy_loss != 0.0) return tip.last_impact().energy_loss;
  }
  return stored_energy(model, tip.state()) / energy - 1.0;
}

// Rounding alone wanders by 1e-13; what it has in common from impact to impact, a few 1e-18, is seen here.
TEST(Energy, OfAnElasticTipAtRestDoesNotDrift) {
  double sum = 0.0;
  int starts = 0;
  for (const double phase : {0.1, 0.25, 0.37, 0.45, 0.6, 0.8}) {
    for (const double velocity : {0.1, 0.5, 1.3}) {
      const double drift = drift_at_rest(phase, velocity);
      EXPECT_NEAR(drift, 0.0, 3e-12) << phase << ", " << velocity;
      sum += drift;
      ++starts;
    }
  }
  EXPECT_NEAR(sum / starts, 0.0, 1e-12);
}

}  // namespace
}  // namespace afm
