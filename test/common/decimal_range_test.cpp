#include "common/decimal_range.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <stdexcept>
#include <string>
#include <vector>

namespace afm {
namespace {

TEST(DecimalRange, EveryValueIsTheNumberMeant) {
  const std::vector<double> values = parse_range("0:9:0.01");
  ASSERT_EQ(values.size(), 901u);
  for (std::size_t i = 0; i < values.size(); ++i) {
    ASSERT_EQ(values[i], std::strtod((std::to_string(i) + "e-2").c_str(), nullptr)) << i;
  }
  EXPECT_EQ(parse_range("1:2:0.3"), (std::vector<double>{1.0, 1.3, 1.6, 1.9}));
  EXPECT_EQ(parse_range("-0.2:.1:1e-1"), (std::vector<double>{-0.2, -0.1, 0.0, 0.1}));
  EXPECT_EQ(parse_range("3.4"), std::vector<double>{3.4});
  EXPECT_EQ(parse_range("1:1:1"), std::vector<double>{1.0});
  EXPECT_EQ(parse_range("3.4000000000000004"), std::vector<double>{3.4000000000000004});
}

TEST(DecimalRange, WhatIsNoRangeIsRefused) {
  for (const char* text : {"", "a", "1:2", "1:2:3:4", "1:2:0", "1:2:-1", "2:1:1", "1:2:x", "1:2:0.5:", "nan", "inf",
                           "1e", "--1", "1 ", "0:1:1e-9", "1:2:1e-30", "0x10", "1..2", ":", "1::2"}) {
    EXPECT_THROW(parse_range(text), std::invalid_argument) << text;
  }
}

}  // namespace
}  // namespace afm
