#include "bernstein_fall.h"

#include <cstddef>

namespace afm::detail {

double first_bernstein_fall(const AtGaussNodes& b, double low, double width, int halvings) {
  constexpr std::size_t kN = kGaussNodes;
  std::size_t first = 0;
  while (first < kN && b[first] > 0.0) ++first;
  if (first == kN) return -1.0;
  if (first == 0) return low;
  if (halvings == 0) {
    const double part = static_cast<double>(first - 1) + b[first - 1] / (b[first - 1] - b[first]);
    return low + width * part / static_cast<double>(kN - 1);
  }
  // de Casteljau's scheme, all of it in registers
  AtGaussNodes head, tail;
#pragma GCC unroll 8
  for (std::size_t i = 0; i < kN; ++i) tail[i] = b[i];
#pragma GCC unroll 8
  for (std::size_t i = 0; i < kN; ++i) {
    head[i] = tail[0];
#pragma GCC unroll 8
    for (std::size_t j = 0; j + i + 1 < kN; ++j) tail[j] = 0.5 * (tail[j] + tail[j + 1]);
  }
  const double fall = first_bernstein_fall(head, low, 0.5 * width, halvings - 1);
  return fall >= 0.0 ? fall : first_bernstein_fall(tail, low + 0.5 * width, 0.5 * width, halvings - 1);
}

}  // namespace afm::detail
