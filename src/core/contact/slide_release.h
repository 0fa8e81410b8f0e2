// The time at which a slide leaves the surface.
#pragma once

#include <cmath>
#include <cstddef>

#include "afm/detail/slide_segment.h"
#include "first_fall.h"
#include "release_noise.h"

namespace afm::detail {

// A bound of the change of a series between 0 and s: the sum of the absolute values of its terms.
template <class T>
T largest_change(const Series<T>& series, const T& s) {
  using std::abs;
  using std::fma;
  const T s2 = s * s;
  T even(0.0), odd(0.0);
  for (std::size_t k = kSlideOrder; k >= 2; k -= 2) {
    even = fma(even, s2, abs(series[k]));
    odd = fma(odd, s2, abs(series[k - 1]));
  }
  return s * fma(even, s, odd);
}

// The first time in [0, length()] at which the reaction has fallen to -release_noise(), within a thousandth of that.
// Negative if it does not fall so far. Guarantee: no earlier fall is passed (first_fall.h).
template <class T>
T find_release(const SlideSegment<T>& slide) {
  constexpr double kAccuracy = 1.0 / 1024.0;  // of the noise: finer would be rounding of the reaction
  const T length = slide.length(), noise = release_noise(slide.springs(), slide.start().u, slide.start().X);
  const Series<T>& reaction = slide.reaction();
  const T pressed = reaction[0] + noise;
  if (pressed > largest_change(reaction, length)) return T(-1.0);
  if (pressed <= T(kAccuracy) * noise) return T(0.0);
  Series<T> pull = reaction;
  pull[0] = pressed;
  return first_fall(pull, length, T(kAccuracy * noise));
}

}  // namespace afm::detail
