#include "afm/detail/turns.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "trials/quad.h"

namespace afm {

using namespace detail;

namespace {

constexpr double kUlps = 0.8;  // what turns.h claims

double sin_cos_error(double x) {
  const SinCos<double> value = sin_cos_turns(x);
  const SinCos<Quad> truth = sin_cos_turns(Quad(x));
  return std::max(error_in_ulp(value.sin, truth.sin), error_in_ulp(value.cos, truth.cos));
}

TEST(Turns, SineAndCosineAreWithinTheirUlps) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> within_turns(-3.0, 3.0);
  for (int i = 0; i < 200000; ++i) {
    const double x = within_turns(random);
    ASSERT_LE(sin_cos_error(x), kUlps) << x;
  }
}

TEST(Turns, SineAndCosineHoldBesideEveryEighthTurn) {
  for (int eighth = -24; eighth <= 24; ++eighth) {
    const double centre = 0.125 * eighth;
    double up = centre, down = centre;
    for (int i = 0; i < 200; ++i, up = std::nextafter(up, 9.0), down = std::nextafter(down, -9.0)) {
      ASSERT_LE(sin_cos_error(up), kUlps) << up;
      ASSERT_LE(sin_cos_error(down), kUlps) << down;
    }
    for (int k = 1; k <= 60; ++k) {
      ASSERT_LE(sin_cos_error(centre + std::ldexp(0.77, -k)), kUlps) << eighth << " " << k;
      ASSERT_LE(sin_cos_error(centre - std::ldexp(0.77, -k)), kUlps) << eighth << " " << k;
    }
  }
}

TEST(Turns, TinyAndHugeArgumentsKeepTheirDigits) {
  std::mt19937_64 random(2);
  std::uniform_real_distribution<double> mantissa(0.5, 1.0);
  for (int exponent = -900; exponent <= 48; ++exponent) {
    for (int i = 0; i < 20; ++i) {
      const double x = std::ldexp(mantissa(random), exponent);
      ASSERT_LE(sin_cos_error(x), kUlps) << x;
      ASSERT_LE(sin_cos_error(-x), kUlps) << -x;
    }
  }
}

TEST(Turns, SmallTurnKeepsEachPartToAFewUlpOfItself) {
  std::mt19937_64 random(4);
  std::uniform_real_distribution<double> mantissa(0.5, 1.0);
  for (int i = 0; i < 100000; ++i) {
    const double x = (i % 2 == 0 ? 0.125 : -0.125) * std::ldexp(mantissa(random), -(i % 150));
    const SmallTurn<double> value = small_turn(x);
    const SmallTurn<Quad> truth = small_turn(Quad(x));
    ASSERT_LE(error_in_ulp(value.sin, truth.sin), kUlps) << x;
    ASSERT_LE(error_in_ulp(value.sin_minus_angle, truth.sin_minus_angle), 5.0) << x;
    ASSERT_LE(error_in_ulp(value.versine, truth.versine), 5.0) << x;
  }
}

TEST(Turns, TurnProductKeepsTheFractionOfALargeProduct) {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> factor(-1.0, 1.0);
  for (int i = 0; i < 10000; ++i) {
    const double a = 1e3 * factor(random), b = std::ldexp(factor(random), i % 34);
    const Quad truth = turn_product(Quad(a), Quad(b));  // 106 bits: exact in 113
    const Quad apart = abs(turn_product(a, b) - truth);
    // beside a half turn it may come out on the other side, a whole turn apart
    const Quad error = std::min(apart, Quad(abs(apart - 1)));
    ASSERT_LE(static_cast<double>(error), epsilon<double>() / 2.0) << a << " * " << b;
    ASSERT_LE(std::abs(turn_product(a, b)), 0.51) << a << " * " << b;
  }
}

}  // namespace
}  // namespace afm
