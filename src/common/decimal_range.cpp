#include "decimal_range.h"

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <stdexcept>

namespace afm {
namespace {

constexpr int kMostDigits = 17;  // of a mantissa: all that a double has; sums of two mantissas stay whole in 64 bits

struct Decimal {
  std::int64_t mantissa = 0;
  int exponent = 0;  // value = mantissa 10^exponent
};

[[noreturn]] void refuse(const std::string& reason) { throw std::invalid_argument(reason); }

// Digits with a point somewhere among them; `at` is moved past them.
Decimal parse_digits(const std::string& text, std::size_t& at) {
  Decimal d;
  bool point = false;
  int digits = 0, significant = 0;
  for (; at < text.size() && (std::isdigit(static_cast<unsigned char>(text[at])) || (text[at] == '.' && !point));
       ++at) {
    if (text[at] == '.') {
      point = true;
      continue;
    }
    ++digits;
    if (d.mantissa != 0 || text[at] != '0') ++significant;
    if (significant > kMostDigits) refuse("'" + text + "' has more than 17 digits");
    d.mantissa = 10 * d.mantissa + (text[at] - '0');
    if (point) --d.exponent;
  }
  if (digits == 0) refuse("'" + text + "' is not a number");
  return d;
}

Decimal parse_decimal(const std::string& text) {
  std::size_t at = !text.empty() && (text[0] == '-' || text[0] == '+') ? 1 : 0;
  Decimal d = parse_digits(text, at);
  if (text[0] == '-') d.mantissa = -d.mantissa;
  if (at < text.size() && (text[at] == 'e' || text[at] == 'E')) {
    char* end = nullptr;
    const char* begin = text.c_str() + at + 1;
    const long exponent = std::strtol(begin, &end, 10);
    if (end == begin || std::labs(exponent) > 300) refuse("'" + text + "' is not a number");
    d.exponent += static_cast<int>(exponent);
    at = static_cast<std::size_t>(end - text.c_str());
  }
  if (at != text.size()) refuse("'" + text + "' is not a number");
  return d;
}

// The mantissa it has with a smaller exponent.
std::int64_t mantissa_at(int exponent, const Decimal& d) {
  constexpr std::int64_t kMost = 1000000000000000000;
  std::int64_t mantissa = d.mantissa;
  for (int e = d.exponent; e > exponent && mantissa != 0; --e) {
    if (std::abs(mantissa) > kMost / 10) refuse("FROM, TO and STEP are too far apart to be added exactly");
    mantissa *= 10;
  }
  return mantissa;
}

double to_double(std::int64_t mantissa, int exponent) {
  return std::strtod((std::to_string(mantissa) + "e" + std::to_string(exponent)).c_str(), nullptr);
}

std::vector<std::string> split(const std::string& text) {
  std::vector<std::string> parts(1);
  for (const char c : text) {
    if (c == ':') {
      parts.emplace_back();
    } else {
      parts.back() += c;
    }
  }
  return parts;
}

}  // namespace

std::vector<double> parse_range(const std::string& text) {
  const std::vector<std::string> parts = split(text);
  if (parts.size() == 1) {
    const Decimal d = parse_decimal(text);
    return {to_double(d.mantissa, d.exponent)};
  }
  if (parts.size() != 3) refuse("must be one number or FROM:TO:STEP");
  const Decimal from = parse_decimal(parts[0]), to = parse_decimal(parts[1]), step = parse_decimal(parts[2]);
  const int exponent = std::min({from.exponent, to.exponent, step.exponent});
  const std::int64_t first = mantissa_at(exponent, from), last = mantissa_at(exponent, to);
  const std::int64_t by = mantissa_at(exponent, step);
  if (by <= 0) refuse("STEP must be above 0");
  if (last < first) refuse("TO must not be below FROM");
  if ((last - first) / by >= static_cast<std::int64_t>(kMostRangeValues)) refuse("more than a million values");
  std::vector<double> values;
  for (std::int64_t mantissa = first; mantissa <= last; mantissa += by) values.push_back(to_double(mantissa, exponent));
  return values;
}

}  // namespace afm
