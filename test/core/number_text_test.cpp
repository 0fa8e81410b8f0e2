#include "afm/number_text.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <random>

namespace afm {
namespace {

TEST(NumberText, IsWhatPeopleWrite) {
  EXPECT_EQ(number_text(1e-6), "1e-06");  // with 17 digits 9.9999999999999995e-07
  EXPECT_EQ(number_text(0.1), "0.1");
  EXPECT_EQ(number_text(-0.7), "-0.7");
  EXPECT_EQ(number_text(0.0), "0");
  EXPECT_EQ(number_text(200.0), "200");
  EXPECT_EQ(number_text(300000.0), "300000");
  EXPECT_EQ(number_text(1e9), "1e+09");
  EXPECT_EQ(number_text(1.0 / 3.0), "0.3333333333333333");
  EXPECT_EQ(number_text(std::numeric_limits<double>::infinity()), "inf");
  EXPECT_EQ(number_text(std::numeric_limits<double>::quiet_NaN()), "nan");
}

TEST(NumberText, GivesTheSameNumberBack) {
  std::mt19937_64 random(42);
  for (int i = 0; i < 20000; ++i) {
    const std::uint64_t bits = random();
    double value;
    std::memcpy(&value, &bits, sizeof value);
    if (!std::isfinite(value)) continue;
    ASSERT_EQ(std::strtod(number_text(value).c_str(), nullptr), value);
  }
}

}  // namespace
}  // namespace afm
