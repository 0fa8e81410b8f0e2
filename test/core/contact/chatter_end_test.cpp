// How chatter ends: let go at a bounce, died into contact, or, where the restitution knows no cutoff, at its
// accumulation point.
#include <gtest/gtest.h>

#include <cmath>

#include "support/chatters.h"
#include "support/models.h"

namespace afm {

using namespace detail;

namespace {

constexpr double kThreshold = 1e-5;  // of the default tolerance

class ChatterEnds : public testing::TestWithParam<double> {};

TEST_P(ChatterEnds, ItLetsGoAtABounce) {
  const Model model = model_with(GetParam(), 0.05);
  const ChatterLaw law(model, kDefaultContactTolerance);
  RandomLaunches random(4);
  int exits = 0;
  for (int i = 0; i < 2000; ++i) {
    const RandomChatter chatter = random_chatter(model, law, random, -3.5, -2.0);
    const ChatterRun run = law.run(chatter.reference, chatter.reference.length(), {chatter.v, 0.0});
    if (run.end != ChatterEnd::exits) continue;
    ++exits;
    ASSERT_EQ(run.chatter.n, std::floor(run.chatter.n));
    ASSERT_GE(run.chatter.n, 1.0);
    if (run.chatter.n > 100.0) continue;
    Tip tip = chatter.every_bounce();
    for (int n = 1; n <= static_cast<int>(run.chatter.n); ++n) tip.advance(kEndOfTime);
    const double bounce = 2.0 * run.chatter.v / chatter.reference.pressure(run.s);
    ASSERT_NEAR(tip.now() - ModelTime{}, run.s, 0.1 * bounce) << i;
    ASSERT_NEAR(project_onto_surface(model, tip.tip_state()).normal_speed, run.chatter.v, 2.0 * kThreshold) << i;
  }
  EXPECT_GT(exits, 20);
}

// The last step ends below the threshold: its bounces there were counted too, 60 % of all at worst.
TEST_P(ChatterEnds, WhatDiesCountsItsBouncesDownToTheThreshold) {
  const Model model = model_with(GetParam(), 0.05);
  const ChatterLaw law(model, kDefaultContactTolerance);
  RandomLaunches random(6);
  int died = 0;
  for (int i = 0; i < 300; ++i) {
    const RandomChatter chatter = random_chatter(model, law, random, -4.0, -2.5);
    const ChatterRun run = law.run(chatter.reference, chatter.reference.length(), {chatter.v, 0.0});
    if (run.end != ChatterEnd::died) continue;
    ++died;
    Tip tip = chatter.every_bounce();
    int count = 0;
    while (project_onto_surface(model, tip.tip_state()).normal_speed > kThreshold &&
           tip.advance(kEndOfTime) == Outcome::impact)
      ++count;
    ASSERT_NEAR(run.chatter.n, count, 1.0 + 0.01 * count) << i;
  }
  if (GetParam() > 0.9) return;  // the slide is over before
  EXPECT_GT(died, 2);
}

// Next to the threshold the speed may hardly fall, or rise first: no less is counted at the end than on the way.
TEST_P(ChatterEnds, ACountDoesNotFall) {
  const Model model = model_with(GetParam(), 0.05);
  const ChatterLaw law(model, kDefaultContactTolerance);
  RandomLaunches random(7);
  for (int i = 0; i < 1000; ++i) {
    const RandomChatter chatter = random_chatter(model, law, random, -4.9999, -4.8);
    const ChatterRun run = law.run(chatter.reference, chatter.reference.length(), {chatter.v, 0.0});
    if (run.end != ChatterEnd::died) continue;
    ASSERT_GE(run.chatter.n, 0.0) << i;
    for (int k = 1; k < 20; ++k) {
      const ChatterRun part = law.run(chatter.reference, run.s * k / 20.0, {chatter.v, 0.0});
      ASSERT_LE(part.chatter.n, 1.0 + 1.02 * run.chatter.n) << i;
    }
  }
}

// The sum of the geometric series of all bounces from one of gap rate v on, at time s.
double rest_of_zeno(const RandomChatter& chatter, double s, double v) {
  return 2.0 * v / (chatter.reference.pressure(s) * (1.0 - chatter.model.gamma));
}

TEST_P(ChatterEnds, WithoutACutoffItEndsAtItsAccumulationPoint) {
  const Model model = model_with(GetParam(), 0.0);
  if (model.gamma == 1.0) return;  // then it never ends
  const ChatterLaw law(model, kDefaultContactTolerance);
  RandomLaunches random(5);
  int compared = 0;
  for (int i = 0; i < 300; ++i) {
    const RandomChatter chatter = random_chatter(model, law, random, -4.0, -2.5);
    Tip bounces = chatter.every_bounce(), tip(model, chatter.reference.eta(), bounces.tip_state());
    if (tip.advance(kEndOfTime) != Outcome::impact || tip.tip_state().g1 > 0.0) continue;  // let go before
    const Impact burst = tip.last_impact();
    ASSERT_EQ(burst.kind, ImpactKind::burst);
    ASSERT_EQ(tip.advance(kEndOfTime), Outcome::contact);
    const double end = tip.now() - ModelTime{};
    int count = 0;
    const ModelTime late = tip.now() + 1.0;
    while (project_onto_surface(model, bounces.tip_state()).normal_speed > kThreshold &&
           bounces.advance(late) == Outcome::impact)
      ++count;
    ASSERT_NEAR(burst.count, count, 1.5 + 0.05 * count) << i;
    while (bounces.tip_state().g1 > 1e-9 && bounces.advance(late) == Outcome::impact) continue;
    if (bounces.now() == late) continue;  // let go after all, of less than the threshold
    const double s = bounces.now() - ModelTime{};
    // contact is made when the gap rate is below the threshold: by so much the end is early, and so well it is known
    ASSERT_NEAR(s + rest_of_zeno(chatter, s, bounces.tip_state().g1), end,
                kDefaultContactTolerance + 2.0 * rest_of_zeno(chatter, end, kThreshold))
        << i;
    if (tip.advance(bounces.now()) != Outcome::time_limit) continue;
    ++compared;
    ASSERT_NEAR(tip.tip_state().phase, bounces.tip_state().phase, kDefaultContactTolerance) << i;
    ASSERT_NEAR(tip.tip_state().X, bounces.tip_state().X, kDefaultContactTolerance) << i;
    ASSERT_NEAR(tip.tip_state().u, bounces.tip_state().u, kDefaultContactTolerance) << i;
  }
  EXPECT_GT(compared, 20);
}

INSTANTIATE_TEST_SUITE_P(Restitutions, ChatterEnds, testing::Values(1.0, 0.99, 0.7, 0.3, 0.0));

}  // namespace
}  // namespace afm
