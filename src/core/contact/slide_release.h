// The time at which a slide leaves the surface: the first zero of a polynomial. Its Bernstein coefficients on an
// interval enclose it there. If their sign does not change, it has no root; if it changes once, exactly one (Descartes'
// rule of signs). Otherwise the interval is halved.
#pragma once

#include <cmath>
#include <cstddef>

#include "afm/detail/slide_segment.h"
#include "core/release_noise.h"

namespace afm::detail {

using Polynomial = Series<double>;

constexpr Polynomial inverse_binomials() {
  Polynomial inverse{};
  double binomial = 1.0;
  for (std::size_t k = 0; k <= kSlideOrder; ++k) {
    inverse[k] = 1.0 / binomial;
    binomial = binomial * static_cast<double>(kSlideOrder - k) / static_cast<double>(k + 1);
  }
  return inverse;
}

// The coefficients on [0, length], by Pascal's triangle.
inline Polynomial bernstein_coefficients(const Polynomial& powers, double length) {
  constexpr Polynomial kInverseBinomial = inverse_binomials();
  Polynomial b{};
  double power = 1.0;
#pragma GCC unroll 32
  for (std::size_t k = 0; k <= kSlideOrder; ++k) {
    b[k] = powers[k] * power * kInverseBinomial[k];
    power *= length;
  }
#pragma GCC unroll 32
  for (std::size_t i = 1; i <= kSlideOrder; ++i) {
#pragma GCC unroll 32
    for (std::size_t j = kSlideOrder; j >= i; --j) b[j] = b[j] + b[j - 1];
  }
  return b;
}

// Returns the coefficients of the second half of the interval; b becomes those of the first half (de Casteljau).
inline Polynomial split_off_half(Polynomial& b) {
  Polynomial last = b;
  for (std::size_t i = 1; i <= kSlideOrder; ++i) {
    for (std::size_t j = 0; j + i <= kSlideOrder; ++j) last[j] = 0.5 * (last[j] + last[j + 1]);
    b[i] = last[0];
  }
  return last;
}

// [low, high] holds the first root and no other, or is too short to decide; `estimate` is near the root. No root: low >
// high.
struct FallInterval {
  double low, high, estimate;
};

inline FallInterval first_fall_within(Polynomial b, double low, double width, int halvings) {
  std::size_t changes = 0, first = 0;
#pragma GCC unroll 32
  for (std::size_t j = kSlideOrder; j >= 1; --j) {
    const bool change = (b[j] > 0.0) != (b[j - 1] > 0.0);
    changes += change ? 1 : 0;
    first = change ? j : first;
  }
  if (changes == 0) return {1.0, 0.0, 0.0};
  if (changes == 1 || halvings == 0) {
    const double part = static_cast<double>(first - 1) + b[first - 1] / (b[first - 1] - b[first]);
    return {low, low + width, low + width * part * (1.0 / static_cast<double>(kSlideOrder))};
  }
  const double half = 0.5 * width;
  const Polynomial last = split_off_half(b);
  const FallInterval fall = first_fall_within(b, low, half, halvings - 1);
  return fall.low <= fall.high ? fall : first_fall_within(last, low + half, half, halvings - 1);
}

// The first time in [0, length] at which the polynomial is within `tolerance` of zero. Negative if it does not fall so
// far. Precondition: it is positive at 0. A double root within rounding may count as a root or not.
inline double first_fall(const Polynomial& polynomial, double length, double tolerance) {
  constexpr int kMaxHalvings = 40;      // down to 1e-12 of the length, below the time resolution of a release
  constexpr int kMaxNewtonSteps = 200;  // bisection replaces a step that would leave the interval
  auto [low, high, s] = first_fall_within(bernstein_coefficients(polynomial, length), 0.0, length, kMaxHalvings);
  if (low > high) return -1.0;
  Polynomial slope{};
#pragma GCC unroll 32
  for (std::size_t k = kSlideOrder; k >= 1; --k) slope[k - 1] = polynomial[k] * static_cast<double>(k);
  for (int i = 0; i < kMaxNewtonSteps; ++i) {
    const double p = horner(polynomial, s);
    if (std::abs(p) <= tolerance) break;
    (p > 0.0 ? low : high) = s;
    const double next = s - p / horner(slope, s);
    s = low < next && next < high ? next : 0.5 * (low + high);
  }
  return s;
}

// A bound of the change of a series between 0 and s: the sum of the absolute values of its terms.
inline double largest_change(const Polynomial& series, double s) {
  const double s2 = s * s;
  double even = 0.0, odd = 0.0;
  for (std::size_t k = kSlideOrder; k >= 2; k -= 2) {
    even = std::fma(even, s2, std::abs(series[k]));
    odd = std::fma(odd, s2, std::abs(series[k - 1]));
  }
  return s * std::fma(even, s, odd);
}

// The first time in [0, length()] at which the reaction has fallen to -release_noise(), within a thousandth of that.
// Negative if it does not fall so far. Guarantee: no earlier fall is passed.
inline double find_release(const SlideSegment<double>& slide) {
  constexpr double kAccuracy = 1.0 / 1024.0;  // of the noise: finer would be rounding of the reaction
  const double noise = release_noise(slide.springs(), slide.start().u, slide.start().X);
  Polynomial pull = slide.reaction();
  pull[0] += noise;
  if (pull[0] > largest_change(pull, slide.length())) return -1.0;
  if (pull[0] <= kAccuracy * noise) return 0.0;
  return first_fall(pull, slide.length(), kAccuracy * noise);
}

}  // namespace afm::detail
