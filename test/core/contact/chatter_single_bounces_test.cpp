// Bounces that lose too much for the averages, made one by one along the reference slide, against the tip's own.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "trials/burst_trials.h"
#include "support/chatters.h"

namespace afm {
namespace {

constexpr ModelTime kNever{std::int64_t{1} << 60, 0.0};
constexpr double kThreshold = 1e-5;

Model model_with(double gamma) {
  Model model;
  model.gamma = gamma;
  model.v_c = 1e-3;
  return model;
}

double median(std::vector<double> x) {
  std::nth_element(x.begin(), x.begin() + static_cast<std::ptrdiff_t>(x.size() / 2), x.end());
  return x[x.size() / 2];
}

class Descents : public testing::TestWithParam<double> {
 protected:
  const Model model_ = model_with(GetParam());
  const ChatterLaw law_{model_, kThreshold};

  // Of the first bounce, the larger of the relative error of its speed and that of its number.
  double first_error(const RandomChatter& chatter) const {
    Tip tip = chatter.every_bounce();
    tip.advance(kNever);
    const Chatter now = law_.at(chatter.reference, tip.now() - ModelTime{}, {chatter.v, 0.0});
    const double v = project_onto_surface(model_, tip.tip_state()).normal_speed;
    return std::max(std::abs(now.v / v - 1.0), std::abs(now.n - 1.0));
  }
};

TEST_P(Descents, ABounceIsToldToTheThirdOrderOfItsDuration) {
  RandomLaunches random(1);
  std::vector<double> ratios;
  for (int i = 0; i < 2000; ++i) {
    RandomChatter chatter = random_chatter(model_, law_, random, -2.0, -1.6);
    const double whole = first_error(chatter);
    ASSERT_LT(whole, 1e-5) << i;
    chatter.v *= 0.5;
    const double half = first_error(chatter);
    if (half > 1e-13) ratios.push_back(whole / half);
  }
  ASSERT_GT(ratios.size(), 1000u);
  EXPECT_GT(median(ratios), 10.0);
}

TEST_P(Descents, AllTheWayDownNumbersAndSpeedsAreThoseOfTheBounces) {
  RandomLaunches random(2);
  std::vector<double> errors;
  for (int i = 0; i < 500; ++i) {
    const RandomChatter chatter = random_chatter(model_, law_, random, -2.5, -1.8);
    const Chatter start{chatter.v, 0.0};
    const double end = law_.run(chatter.reference, 0.0, chatter.reference.length(), start).s;
    Tip tip = chatter.every_bounce();
    for (int n = 1;; ++n) {
      tip.advance(kNever);
      const double t = tip.now() - ModelTime{}, v = project_onto_surface(model_, tip.tip_state()).normal_speed;
      if (t >= end || v < 2e-3) break;
      const Chatter now = law_.at(chatter.reference, t, start);
      ASSERT_NEAR(now.n, n, 3e-4) << i;
      ASSERT_NEAR(now.v, v, 3e-5 * v) << i;
      errors.push_back(std::max(std::abs(now.n - n), std::abs(now.v / v - 1.0)));
    }
  }
  ASSERT_GT(errors.size(), 100u);
  EXPECT_LT(median(errors), 1e-6);
}

// The flow through the bounces is one of a constant restitution: at the cutoff it is a little wrong.
TEST_P(Descents, BegunAgainInTheMiddleItGoesOnTheSameButForPartOfABounce) {
  RandomLaunches random(3);
  std::vector<double> shifts;
  for (int i = 0; i < 500; ++i) {
    const RandomChatter chatter = random_chatter(model_, law_, random, -2.5, -1.8);
    const Chatter start{chatter.v, 0.0};
    const double late = 0.9 * law_.run(chatter.reference, 0.0, chatter.reference.length(), start).s;
    const double middle = random.within(0.0, 0.9) * late;
    const ChatterRun whole = law_.run(chatter.reference, 0.0, late, start);
    const ChatterRun rest = law_.run(chatter.reference, middle, late, law_.at(chatter.reference, middle, start));
    if (whole.s < late || rest.s < late) continue;
    // in bounces such as the first, which last so much longer
    const double part = whole.chatter.v / chatter.v;
    shifts.push_back(part * std::abs(rest.chatter.n - whole.chatter.n));
    ASSERT_LT(shifts.back(), 0.1) << i;
  }
  ASSERT_GT(shifts.size(), 100u);
  EXPECT_LT(median(shifts), 0.01);
}

INSTANTIATE_TEST_SUITE_P(Restitutions, Descents, testing::Values(0.9, 0.7, 0.3));

TEST(Descent, ABurstThatBeginsAboveTheCutoffIsGoodToItsTolerance) {
  constexpr double kTolerance = 1e-3;
  const Model model = model_with(0.7);
  BurstTrials trials(model, 5.05, kTolerance, 1, 20000, false);
  for (int i = 0; i < 100; ++i) ASSERT_LT(trials.next().tempered(), kTolerance) << i;
  Tip tip(model, 5.05, FreeState{0.25, 0.0, 0.2, 5.05, 0.0});
  int above = 0;
  while (tip.now().tau < 200) {
    tip.advance({200, 0.0});
    above += tip.last_impact().kind == ImpactKind::burst && tip.last_impact().normal_speed > model.v_c;
  }
  EXPECT_GT(above, 100);
}

// Where each takes next to nothing they are too many: thousands of them.
TEST(Descent, BouncesAboveTheCutoffThatLoseLittleAreFlown) {
  const Model model = model_with(0.99);
  const ChatterLaw law(model, kThreshold);
  RandomLaunches random(4);
  const RandomChatter below = random_chatter(model, law, random, -4.0, -3.1);
  RandomChatter above = below;
  above.v = 3e-3;
  EXPECT_TRUE(
      law.holds(Flight<double>(below.reference.mechanics(), below.reference.eta(), below.every_bounce().tip_state())));
  EXPECT_FALSE(
      law.holds(Flight<double>(above.reference.mechanics(), above.reference.eta(), above.every_bounce().tip_state())));
}

}  // namespace
}  // namespace afm
