#include "decimal_range.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <sstream>
#include <stdexcept>

#include "csv.h"

namespace afm {
namespace {

[[noreturn]] void refuse(const std::string& reason) { throw std::invalid_argument(reason); }

// Decimal digits alone: no spaces, nothing hexadecimal, neither nan nor inf.
double number_in(const std::string& text) {
  double value = 0.0;
  const bool is_decimal = text.find_first_not_of("0123456789.+-eE") == std::string::npos && parse_number(text, value);
  if (!is_decimal || !std::isfinite(value)) refuse("'" + text + "' is not a number");
  return value;
}

// The least power of ten that makes a whole number of the value. Powers of ten are exact doubles up to 10^22, so a
// whole number over one is rounded once: it is the double nearest to the decimal number.
double scale_of(double value) {
  constexpr double kLargestExact = 1e22;
  for (double ten = 1.0; ten <= kLargestExact; ten *= 10.0) {
    if (std::nearbyint(value * ten) / ten == value) return ten;
  }
  refuse("FROM, TO and STEP have more decimals than can be added exactly");
}

}  // namespace

std::vector<double> parse_range(const std::string& text) {
  constexpr double kLargestWhole = 0x1p53;
  std::vector<std::string> parts;
  std::istringstream rest(text);
  for (std::string part; std::getline(rest, part, ':');) parts.push_back(part);
  if (!text.empty() && text.back() == ':') parts.emplace_back();
  if (parts.size() == 1) return {number_in(text)};
  if (parts.size() != 3) refuse("must be one number or FROM:TO:STEP");
  const double from = number_in(parts[0]), to = number_in(parts[1]), step = number_in(parts[2]);
  const double scale = std::max({scale_of(from), scale_of(to), scale_of(step)});
  if (!(scale * std::max({std::abs(from), std::abs(to), std::abs(step)}) < kLargestWhole)) {
    refuse("FROM, TO and STEP are too far apart to be added exactly");
  }
  const std::int64_t first = std::llround(scale * from), last = std::llround(scale * to);
  const std::int64_t by = std::llround(scale * step);
  if (by <= 0) refuse("STEP must be above 0");
  if (last < first) refuse("TO must not be below FROM");
  if ((last - first) / by >= static_cast<std::int64_t>(kMostRangeValues)) refuse("more than a million values");
  std::vector<double> values;
  for (std::int64_t i = first; i <= last; i += by) values.push_back(static_cast<double>(i) / scale);
  return values;
}

}  // namespace afm
