// Energy: put into a bouncing tip nearly at rest, and kept by an elastic one. The balance of every segment is in
// segment_test.cpp.
#include <gtest/gtest.h>

#include "core/tip/tip_motion.h"
#include "support/models.h"
#include "trials/energy_balance.h"

namespace afm {
namespace {

constexpr double kEveryBounce = 0.0;  // contact tolerance

// A bouncing tip that is nearly at rest: most of its energy of motion is taken from it, or as much is given to it.
TEST(WithEnergy, ATipNearlyAtRestGetsTheEnergyThatItShouldHave) {
  struct Case {
    double frequency_ratio, y0;
    detail::BouncingSlide at;
  };
  constexpr double kRounding = 3e-14;  // of the stored energy
  // on a flank without load, and in a valley under loads that stiffen the swing up to 40 times
  for (const Case& c :
       {Case{33.238413000223808, 0.0, {{0.81885416001572175, -5.4748e-05, 0.00194285}, 0.00186914}},
        Case{6.25, -100.0, {{0.50001, 1e-5, 0.002}, 0.002}}, Case{10.0, -1000.0, {{0.5001, 1e-4, -0.02}, 0.02}}}) {
    Model model;
    model.frequency_ratio = c.frequency_ratio, model.y0 = c.y0, model.H = 0.14353317622964801;
    const SpringConstants<double> m(model);
    const auto energy_of = [&](const detail::BouncingSlide& tip) {
      return detail::slide_energy(m, tip.slide) + 0.5 * tip.v * tip.v;
    };
    const double energy = energy_of(c.at), of_motion = 0.5 * (c.at.slide.u * c.at.slide.u + c.at.v * c.at.v);
    for (int percent = -85; percent <= 90; percent += 5) {
      const double wanted = energy + 1e-2 * percent * of_motion;
      ASSERT_NEAR(energy_of(detail::with_energy(m, c.at, wanted)), wanted, 1e-7 * of_motion + kRounding * energy)
          << percent << " % at " << c.y0;
    }
  }
}

// What an elastic tip at rest gains in a million impacts, as a part of its energy.
double drift_at_rest(double phase, double velocity) {
  const Model model = model_with(1.0, Model().v_c);
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
  for (const double phase : {0.1, 0.37, 0.6}) {
    for (const double velocity : {0.1, 1.3}) {
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
