#include "afm/state.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "afm/model.h"
#include "trials/quad.h"

namespace afm {
namespace {

constexpr double kBelowOne = 1.0 - 0x1p-53;

Quad to_quad(const ModelTime& t) { return Quad(t.tau) + Quad(t.phase); }

TEST(ModelTime, ThePhaseStaysWithinItsTau) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> phase(0.0, 1.0), step(-20.0, 20.0);
  for (int i = 0; i < 100000; ++i) {
    const ModelTime t = ModelTime{i, phase(random)} + step(random);
    ASSERT_GE(t.phase, 0.0);
    ASSERT_LT(t.phase, 1.0);
  }
}

TEST(ModelTime, ASumThatRoundsUpToAWholeTauIsCarried) {
  const ModelTime t = ModelTime{7, kBelowOne} + 0x1p-54;
  EXPECT_EQ(t.tau, 8);
  EXPECT_EQ(t.phase, 0.0);
  const ModelTime back = ModelTime{7, 0.0} + -1e-300;
  EXPECT_EQ(back.tau, 7);
  EXPECT_EQ(back.phase, 0.0);
}

TEST(ModelTime, DifferenceUndoesAddition) {
  std::mt19937_64 random(2);
  std::uniform_real_distribution<double> phase(0.0, 1.0), step(0.0, 8.0);
  for (int i = 0; i < 100000; ++i) {
    const ModelTime a{1000000 + i, phase(random)};
    const double dt = step(random);
    const ModelTime b = a + dt;
    ASSERT_LE(std::abs(static_cast<double>(to_quad(b) - to_quad(a) - Quad(dt))), 0x1p-50);
    ASSERT_NEAR(b - a, dt, 0x1p-49);
    ASSERT_TRUE(a <= b);
  }
}

TEST(ModelTime, OrderIsThatOfTime) {
  const ModelTime early{3, 0.9}, late{4, 0.1};
  EXPECT_TRUE(early < late);
  EXPECT_FALSE(late < early);
  EXPECT_TRUE((ModelTime{3, 0.1}) < early);
  EXPECT_TRUE(early <= early);
  EXPECT_FALSE(early < early);
  EXPECT_TRUE((ModelTime{-1, 0.9}) < (ModelTime{0, 0.0}));
  EXPECT_TRUE(early == (ModelTime{3, 0.9}));
  EXPECT_FALSE(early == late);
}

TEST(ModelTime, SamplesStandOnTheirGridHoweverLongTheRun) {
  for (const double period : {0.03, 0.0063661977236758134, 1.0 / 3.0, 0.1, 7.77, 123.456}) {
    for (const std::uint64_t n : {0ull, 1ull, 33ull, 1000003ull, 9999999999ull, 10000000000ull, 1234567890123ull}) {
      const ModelTime t = multiply(n, period);
      const Quad truth = Quad(n) * Quad(period);  // 41 + 53 bits: exact
      EXPECT_LE(static_cast<double>(abs(to_quad(t) - truth)), 0x1p-52) << n << " * " << period;
      EXPECT_GE(t.phase, 0.0);
      EXPECT_LT(t.phase, 1.0);
    }
  }
}

TEST(TipState, ThereAndBackIsTheSamePlace) {
  const double H = 0.05 / 0.52;
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> phase(0.0, 1.0), length(-0.3, 0.3), speed(-9.0, 9.0);
  for (int i = 0; i < 10000; ++i) {
    const FreeState start{phase(random), length(random), length(random), speed(random), speed(random)};
    const FreeState back = to_free_state(H, to_tip_state(H, start));
    ASSERT_EQ(back.phase, start.phase);
    ASSERT_EQ(back.X, start.X);
    ASSERT_EQ(back.u, start.u);
    ASSERT_NEAR(back.y, start.y, 1e-16);
    ASSERT_NEAR(back.w, start.w, 1e-14);
  }
}

TEST(TipState, CarriesTheGapAndItsRate) {
  const double H = 0.1;
  const TipState tip = to_tip_state(H, {5.25, 0.01, 0.2, 3.0, 1.0});  // rising flank: h = 0, h' = -2 pi H
  EXPECT_EQ(tip.phase, 0.25);
  EXPECT_EQ(tip.g, 0.2);
  EXPECT_NEAR(tip.g1, 1.0 + 3.0 * kTwoPi * H, 1e-15);
}

// Also as others compute its height: by rounding alone two of five such starts were refused.
TEST(State, OnTheSurfaceIsNotBelowIt) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> phase(0.0, 1.0), far(-1e5, 1e5);
  for (const double H : {1e-6, Model().H, 1.0}) {
    for (int i = 0; i < 10000; ++i) {
      const double p = i % 2 == 0 ? phase(random) : far(random);
      ASSERT_GE(to_tip_state(H, {p, 0.0, H * std::cos(kTwoPi * p), 0.0, 0.0}).g, 0.0) << p;
      ASSERT_LT(to_tip_state(H, {p, 0.0, H * std::cos(kTwoPi * p) - 1e-8 * H, 0.0, 0.0}).g, 0.0) << p;
    }
  }
}

}  // namespace
}  // namespace afm
