// Median and tails of what was measured.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

namespace afm {

// The value that so much of them is below; nan where there are none.
inline double quantile(std::vector<double> values, double share) {
  if (values.empty()) return std::nan("");
  const std::size_t n =
      std::min(values.size() - 1, static_cast<std::size_t>(share * static_cast<double>(values.size())));
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(n), values.end());
  return values[n];
}

}  // namespace afm
