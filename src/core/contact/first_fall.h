// The first zero of a polynomial. Its Bernstein coefficients on an interval enclose it there. If their sign does not
// change, it has no root; if it changes once, exactly one (Descartes' rule of signs). Otherwise the interval is halved.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>

#include "afm/detail/slide_series.h"

namespace afm::detail {
constexpr std::array<double, kSlideOrder + 1> inverse_binomials() {
  std::array<double, kSlideOrder + 1> per{};
  double binomial = 1.0;
  for (std::size_t k = 0; k <= kSlideOrder; ++k) {
    per[k] = 1.0 / binomial;
    binomial = binomial * static_cast<double>(kSlideOrder - k) / static_cast<double>(k + 1);
  }
  return per;
}
constexpr std::array<double, kSlideOrder + 1> kInverseBinomial = inverse_binomials();

// The coefficients on [0, length], by Pascal's triangle.
template <class T>
Series<T> bernstein_coefficients(const Series<T>& powers, const T& length) {
  Series<T> b{};
  T power(1.0);
#pragma GCC unroll 32
  for (std::size_t k = 0; k <= kSlideOrder; ++k) {
    b[k] = powers[k] * power * T(kInverseBinomial[k]);
    power = power * length;
  }
#pragma GCC unroll 32
  for (std::size_t i = 1; i <= kSlideOrder; ++i) {
#pragma GCC unroll 32
    for (std::size_t j = kSlideOrder; j >= i; --j) b[j] = b[j] + b[j - 1];
  }
  return b;
}

// Returns the coefficients of the second half of the interval; b becomes those of the first half (de Casteljau).
template <class T>
Series<T> split_off_half(Series<T>& b) {
  Series<T> last = b;
  for (std::size_t i = 1; i <= kSlideOrder; ++i) {
    for (std::size_t j = 0; j + i <= kSlideOrder; ++j) last[j] = T(0.5) * (last[j] + last[j + 1]);
    b[i] = last[0];
  }
  return last;
}

// [low, high] holds the first root and no other, or is too short to decide; `estimate` is near the root. No root: low >
// high.
template <class T>
struct FallInterval {
  T low, high, estimate;
};

template <class T>
FallInterval<T> first_fall_within(Series<T> b, const T& low, const T& width, int halvings) {
  std::size_t changes = 0, first = 0;
#pragma GCC unroll 32
  for (std::size_t j = kSlideOrder; j >= 1; --j) {
    const bool change = (b[j] > T(0.0)) != (b[j - 1] > T(0.0));
    changes += change ? 1 : 0;
    first = change ? j : first;
  }
  if (changes == 0) return {T(1.0), T(0.0), T(0.0)};
  if (changes == 1 || halvings == 0) {
    const T part = T(static_cast<double>(first - 1)) + b[first - 1] / (b[first - 1] - b[first]);
    return {low, low + width, low + width * part * T(1.0 / static_cast<double>(kSlideOrder))};
  }
  const T half = T(0.5) * width;
  const Series<T> last = split_off_half(b);
  const FallInterval<T> fall = first_fall_within(b, low, half, halvings - 1);
  return fall.low <= fall.high ? fall : first_fall_within(last, T(low + half), half, halvings - 1);
}

// The first time in [0, length] at which the polynomial is within `tolerance` of zero. Negative if it does not fall so
// far. Precondition: it is positive at 0. A double root within rounding may count as a root or not.
template <class T>
T first_fall(const Series<T>& polynomial, const T& length, const T& tolerance) {
  using std::abs;
  constexpr int kMaxHalvings = 40;      // down to 1e-12 of the length, below the time resolution of a release
  constexpr int kMaxNewtonSteps = 200;  // bisection replaces a step that would leave the interval
  const Series<T> b = bernstein_coefficients(polynomial, length);
  auto [low, high, s] = first_fall_within(b, T(0.0), length, kMaxHalvings);
  if (low > high) return T(-1.0);
  Series<T> slope{};
#pragma GCC unroll 32
  for (std::size_t k = kSlideOrder; k >= 1; --k) slope[k - 1] = polynomial[k] * T(static_cast<double>(k));
  for (int i = 0; i < kMaxNewtonSteps; ++i) {
    const T p = horner(polynomial, s);
    if (abs(p) <= tolerance) break;
    (p > T(0.0) ? low : high) = s;
    const T next = s - p / horner(slope, s);
    s = low < next && next < high ? next : T(0.5) * (low + high);
  }
  return s;
}

}  // namespace afm::detail
