#include "core/search/double_double.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "trials/quad.h"

namespace afm {

using namespace detail;

namespace {

constexpr double kFewUnits = 2e-31;  // four units of 2^-104
constexpr int kTrials = 100000;

// A number with digits in both halves; a quad holds it exactly.
class Numbers {
 public:
  explicit Numbers(unsigned seed) : random_(seed) {}
  DoubleDouble next() {
    const double high = std::ldexp(mantissa_(random_), exponent_(random_));
    const DoubleDouble low(mantissa_(random_) * high * 1e-16);
    return DoubleDouble(sign_(random_) != 0 ? high : -high) + low;
  }

 private:
  std::mt19937_64 random_;
  std::uniform_real_distribution<double> mantissa_{0.5, 1.0};
  std::uniform_int_distribution<int> exponent_{-40, 40}, sign_{0, 1};
};

TEST(DoubleDouble, SumsKeepThirtyDigits) {
  Numbers numbers(1);
  for (int i = 0; i < kTrials; ++i) {
    const DoubleDouble a = numbers.next(), b = numbers.next();
    ASSERT_LE(relative_error(to_quad(a + b), to_quad(a) + to_quad(b)), kFewUnits);
    ASSERT_LE(relative_error(to_quad(a - b), to_quad(a) - to_quad(b)), kFewUnits);
  }
}

TEST(DoubleDouble, ProductsQuotientsAndRootsKeepThirtyDigits) {
  Numbers numbers(3);
  for (int i = 0; i < kTrials; ++i) {
    const DoubleDouble a = numbers.next(), b = numbers.next();
    ASSERT_LE(relative_error(to_quad(a * b), to_quad(a) * to_quad(b)), kFewUnits);
    ASSERT_LE(relative_error(to_quad(a / b), to_quad(a) / to_quad(b)), kFewUnits);
    ASSERT_LE(relative_error(to_quad(sqrt(abs(a))), sqrt(abs(to_quad(a)))), kFewUnits);
  }
}

TEST(DoubleDouble, OrderLooksAtBothHalves) {
  const DoubleDouble one(1.0), above(1.0, 1e-20), below(1.0, -1e-20);
  EXPECT_TRUE(below < one);
  EXPECT_TRUE(one < above);
  EXPECT_TRUE(above > below);
  EXPECT_TRUE(one <= one);
  EXPECT_FALSE(one < one);
  EXPECT_FALSE(above <= one);
}

TEST(DoubleDouble, SineAndCosineOfTurnsKeepThirtyDigits) {
  std::mt19937_64 random(4);
  std::uniform_real_distribution<double> within_turns(-20.0, 20.0), small(-1e-17, 1e-17);
  for (int i = 0; i < 20000; ++i) {
    const DoubleDouble x = DoubleDouble(within_turns(random)) + DoubleDouble(small(random));
    const SinCos<DoubleDouble> value = sin_cos_turns(x);
    const SinCos<Quad> truth = sin_cos_turns(to_quad(x));
    ASSERT_LE(static_cast<double>(abs(to_quad(value.sin) - truth.sin)), 1e-30) << x.high();
    ASSERT_LE(static_cast<double>(abs(to_quad(value.cos) - truth.cos)), 1e-30) << x.high();
  }
}

}  // namespace
}  // namespace afm
