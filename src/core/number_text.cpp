#include "afm/number_text.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <locale>
#include <sstream>

namespace afm {
namespace {

constexpr int kEnough = std::numeric_limits<double>::max_digits10;
constexpr double kMostInDecimals = 1e7;

bool reads_as(const std::string& text, double value) {
  std::istringstream in(text);
  in.imbue(std::locale::classic());
  double read = 0.0;
  in >> read;
  return read == value;
}

}  // namespace

std::string rounded_text(double value, int digits) {
  if (std::isnan(value)) return "nan";  // whatever its sign
  std::ostringstream out;
  out.imbue(std::locale::classic());
  out.precision(digits);
  out << value;
  return out.str();
}

std::string number_text(double value) {
  int digits = 1;
  while (digits < kEnough && !reads_as(rounded_text(value, digits), value)) ++digits;
  const double size = std::abs(value);
  int before_point = 0;
  for (double power = 1.0; size >= power && size < kMostInDecimals; power *= 10.0) ++before_point;
  return rounded_text(value, std::max(digits, before_point));
}

}  // namespace afm
