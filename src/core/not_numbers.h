// The results of arithmetic where there is no number.
#pragma once

#include <limits>

namespace afm {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

}  // namespace afm
