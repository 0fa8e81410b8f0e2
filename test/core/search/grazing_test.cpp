// Flights built to pass the surface at a given distance: deeper than rounding, within it, and on starts as near as
// doubles are.
#include <gtest/gtest.h>

#include <cmath>

#include "afm/landing.h"
#include "trials/grazes.h"

namespace afm {
namespace {

using Build = Graze (Grazes::*)(double);
struct Kind {
  Build build;
  int flights;
};

class Grazing : public testing::TestWithParam<Kind> {
 protected:
  // 10^-3 to 10^-15 H above the surface, or below
  GrazeCount decide_all(double side) {
    Grazes grazes(side > 0.0 ? 1 : 2);
    GrazeCount count;
    for (int digits = 3; digits <= 15; ++digits) {
      const double clearance = side * std::pow(10.0, -digits) * Model().H;
      for (int i = 0; i < GetParam().flights; ++i) {
        const Graze graze = (grazes.*GetParam().build)(clearance);
        EXPECT_TRUE(decide_neighbours(graze, 1, count)) << digits << " digits, eta " << graze.eta;
      }
    }
    return count;
  }
};

TEST_P(Grazing, AboveTheSurfaceIsAMiss) {
  const GrazeCount count = decide_all(1.0);
  EXPECT_EQ(count.wrong, 0);
  EXPECT_GT(count.missed, 12 * count.touched);  // the very nearest come out on either side
}

TEST_P(Grazing, BelowTheSurfaceIsATouch) {
  const GrazeCount count = decide_all(-1.0);
  EXPECT_EQ(count.wrong, 0);
  EXPECT_GT(count.touched, 12 * count.missed);
}

TEST_P(Grazing, WithinRoundingTheExactAnswerIsFound) {
  // aimed at 0, each comes out a rounding error above or below it
  Grazes grazes(3);
  GrazeCount count;
  for (int i = 0; i < 2 * GetParam().flights; ++i) decide_neighbours((grazes.*GetParam().build)(0.0), 2, count);
  EXPECT_EQ(count.wrong, 0);
  EXPECT_GT(count.finer, (count.touched + count.missed) / 2);
  EXPECT_GT(count.touched, 0);
  EXPECT_GT(count.missed, 0);
}

INSTANTIATE_TEST_SUITE_P(, Grazing,
                         testing::Values(Kind{&Grazes::after_a_flight, 60}, Kind{&Grazes::after_the_start, 2},
                                         Kind{&Grazes::every_tau, 1}));

TEST(Grazes, AHorizonAtTheGrazeChangesNoDecision) {
  Grazes grazes(4);
  for (int i = 0; i < 300; ++i) {
    const Graze graze = grazes.after_a_flight((i % 3 - 1) * 1e-12);
    const Flight<double> flight(SpringConstants<double>(graze.model), graze.eta, graze.start);
    const Landing<double> whole = find_landing(graze.model, flight, kGrazeHorizon);
    for (const double horizon : {graze.s - 1e-5, graze.s - 1e-9, graze.s, graze.s + 1e-9, graze.s + 1e-5}) {
      const Landing<double> part = find_landing(graze.model, flight, horizon);
      ASSERT_NE(part.outcome, SearchOutcome::cap);
      if (whole.s < horizon - 1e-9) {
        ASSERT_NEAR(part.s, whole.s, 1e-9) << i;
      } else if (whole.s > horizon + 1e-9) {
        ASSERT_EQ(part.outcome, SearchOutcome::clear) << i;
        ASSERT_EQ(part.s, horizon) << i;
      }
    }
  }
}

TEST(Grazes, ATouchBelowTheDigitsOfDoubleHasAnImpactOfNoSpeed) {
  Grazes grazes(6);
  int hidden = 0;
  for (int i = 0; i < 400; ++i) {
    const Graze graze = grazes.after_a_flight(0.0);
    const Flight<double> flight(SpringConstants<double>(graze.model), graze.eta, graze.start);
    if (detail::find_impact(flight, kGrazeHorizon).outcome != SearchOutcome::undecided) continue;
    ++hidden;
    const Landing<double> landing = find_landing(graze.model, flight, kGrazeHorizon);
    ASSERT_NE(landing.outcome, SearchOutcome::undecided);
    if (landing.s > graze.s + 1e-5) continue;
    ASSERT_LE(landing.jet.g1, 0.0);
    ASSERT_GT(landing.jet.g1, -1e-4);
  }
  EXPECT_GT(hidden, 100);
}

}  // namespace
}  // namespace afm
