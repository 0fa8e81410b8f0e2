// The Taylor series of a slide about a state: the springs of the paper's section IV with the reaction lambda of the
// surface along y [a/tau^2].
#pragma once

#include <array>
#include <cmath>
#include <cstddef>

#include "afm/spring_constants.h"
#include "rounded.h"
#include "turns.h"

namespace afm::detail {

// On the surface, moving along it: phase [a], extension [a], lab velocity [a/tau].
template <class T>
struct SlideState {
  T phase, X, u;
};

// a choice: the work grows like its square, the length like 2^(-kSlideBits/order)
constexpr std::size_t kSlideOrder = 18;

template <class T>
using Series = std::array<T, kSlideOrder + 1>;

// The sum of a series at s. Even and odd powers are summed separately, which halves the chain of dependent operations.
template <class T>
T horner(const Series<T>& c, const T& s) {
  using std::fma;
  const T s2 = s * s;
  T even = c[kSlideOrder], odd = c[kSlideOrder - 1];
#pragma GCC unroll 32
  for (std::size_t k = kSlideOrder - 2; k >= 2; k -= 2) {
    even = fma(even, s2, c[k]);
    odd = fma(odd, s2, c[k - 1]);
  }
  return fma(fma(even, s, odd), s, c[0]);
}

// Coefficients of the powers of the time since the start.
template <class T>
struct SlideSeries {
  Series<T> d, u, lambda;  // x - x(start), x', reaction
};

// Order n of the product of two series, without its first and last `skip` terms. The sum runs from the middle outwards,
// because the outermost coefficients are known last. Precondition: n >= 2 skip - 1.
template <class T, class A, class B>
inline T product_order(const A& a, const B& b, std::size_t n, std::size_t skip) {
  using std::fma;
  T low(0.0), high = n % 2 == 0 ? T(a[n / 2] * b[n / 2]) : T(0.0);
  for (std::size_t i = (n + 1) / 2; i-- > skip;) {
    low = fma(a[i], b[n - i], low);
    high = fma(a[n - i], b[i], high);
  }
  return low + high;
}

// With r = -h'(x) and c = -h''(x) along the slide: r' = c u and c' = -(2 pi)^2 r u, as the surface is a cosine. For
// a tip of mass 1 that is free along x:
//   x'' = -omega_h^2 X + r lambda,   lambda = y'' + omega_v^2 (h - y0) = c - omega_v^2 y0 - (r u)',
// as y' = -r u and omega_v is the surface's wave number too. Each order gives two linear equations for x'' and lambda;
// the hammer has x'' = 0. The coefficients of the order before, u[n] and c[n], enter last.
template <class T>
inline void write_slide_series(const SpringConstants<T>& m, const T& eta, const SlideState<T>& start,
                               SlideSeries<T>& series) {
  using std::fma;
  const SinCos<T> turn = sin_cos_turns(start.phase);
  const T k = two_pi<T>(), k2 = k * k, wh2 = m.omega_h * m.omega_h;
  std::array<T, kSlideOrder + 3> r, c;
  auto &d = series.d, &u = series.u, &lambda = series.lambda;
  r[0] = k * m.H * turn.sin, c[0] = k2 * m.H * turn.cos, c[1] = -k2 * (r[0] * start.u);
  u[0] = start.u, d[0] = T(0.0);
  const T inverse_mass = m.is_free_along_x / (T(1.0) + r[0] * r[0]), weight = m.omega_v * m.omega_v * m.y0;
  T X = start.X;  // of order n
  for (std::size_t n = 0; n <= kSlideOrder; ++n) {
    const double next = static_cast<double>(n + 1);
    T pull = -wh2 * X, cu = c[0] * u[0], level = c[n] - weight;  // (c u)[n]
    if (n > 0) {
      pull = fma(r[n], lambda[0], pull) + product_order<T>(r, lambda, n, 1);
      cu = fma(c[0], u[n], fma(c[n], u[0], product_order<T>(c, u, n, 1)));
      level = c[n];
    }
    const T inner = product_order<T>(r, u, n + 1, 1);            // (r u)[n + 1] without r[0] u[n + 1] and r[n + 1] u[0]
    const T rest = fma(-u[0], cu, fma(T(-next), inner, level));  // lambda without x''
    const T x2 = fma(r[0] * inverse_mass, rest, inverse_mass * pull);
    lambda[n] = fma(-r[0], x2, rest);
    X = divide(T(u[n] - (n == 0 ? eta : T(0.0))), next);
    if (n < kSlideOrder) {
      d[n + 1] = divide(u[n], next);
      r[n + 1] = divide(cu, next);
      u[n + 1] = divide(x2, next);
      c[n + 2] = divide(T(-k2 * fma(r[0], u[n + 1], fma(u[0], r[n + 1], inner))), next + 1.0);
    }
  }
}

}  // namespace afm::detail
