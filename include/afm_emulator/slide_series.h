// The Taylor series of a slide: each order follows from those before by products of series. The orders are unrolled
// when compiled, and each product takes the newest terms last, so that the rest of it need not wait for them.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>

#include "afm_emulator/flight.h"

namespace afm {

// On the surface, moving along it.
template <class T>
struct SlideState {
  T phase, X, u;
};

constexpr std::size_t kSlideOrder = 18;

template <class T>
using Series = std::array<T, kSlideOrder + 1>;

// Even and odd powers side by side.
template <class T>
T horner(const Series<T>& c, const T& s) {
  using std::fma;
  const T s2 = s * s;
  T even = c[kSlideOrder], odd = c[kSlideOrder - 1];
  for (std::size_t k = kSlideOrder - 2; k >= 2; k -= 2) {
    even = fma(even, s2, c[k]);
    odd = fma(odd, s2, c[k - 1]);
  }
  return fma(fma(even, s, odd), s, c[0]);
}

// The part of coefficient n of the product of two series that terms n - 1 of either need not be waited for.
template <std::size_t n, class T>
T early_product(const Series<T>& a, const Series<T>& b) {
  using std::fma;
  T even(0.0), odd(0.0);
#pragma GCC unroll 32
  for (std::size_t k = 2; k + 1 < n; k += 2) even = fma(a[k], b[n - k], even);
#pragma GCC unroll 32
  for (std::size_t k = 3; k + 1 < n; k += 2) odd = fma(a[k], b[n - k], odd);
  return even + odd;
}

// The same with a[n - 1] b[1], without a[1] b[n - 1].
template <std::size_t n, class T>
T older_product(const Series<T>& a, const Series<T>& b) {
  using std::fma;
  if constexpr (n < 3) return T(0.0);
  if constexpr (n > 2) return fma(a[n - 1], b[1], early_product<n>(a, b));
}

// Without terms n.
template <std::size_t n, class T>
T inner_product(const Series<T>& a, const Series<T>& b) {
  using std::fma;
  if constexpr (n < 2) return T(0.0);
  if constexpr (n == 2) return a[1] * b[1];
  if constexpr (n > 2) return fma(a[1], b[n - 1], older_product<n>(a, b));
}

// Powers of the time since the start.
template <class T>
struct SlideSeries {
  SlideSeries(const Mechanics<T>& m, const T& eta, const SlideState<T>& start);

  Series<T> d, u, lambda;  // x - x(start), x', reaction
};

// With r = -h', c = -h'' and the reaction lambda (of the surface on a tip of mass 1, along y):
//   x'' = -omega_h^2 X + r lambda,   lambda = y'' + omega_v^2 (h - y0) = c - omega_v^2 y0 - (r u)',
// as y' = -r u and omega_v is the surface's wave number too; and c' = -(2 pi)^2 r u. So three products of series are
// all there is. They are written in place: a copy of what has just been written number by number waits until it is in
// memory, a fifth of a piece's time.
template <class T>
class SlideOrders {
 public:
  SlideOrders(const Mechanics<T>& m, const T& eta, const SlideState<T>& start, SlideSeries<T>& series);

 private:
  template <std::size_t n>
  void add_order();
  template <std::size_t n>
  void finish_order(const T& r1, const T& rest, const T& fall, const T& pulled);

  Series<T>&d, &u, &lambda;
  Series<T> r, c, X;
  T k2, wh2, inertia, pull, r_inertia;
};

template <class T>
SlideOrders<T>::SlideOrders(const Mechanics<T>& m, const T& eta, const SlideState<T>& start, SlideSeries<T>& series)
    : d(series.d),
      u(series.u),
      lambda(series.lambda),
      k2(two_pi<T>() * two_pi<T>()),
      wh2(m.omega_h * m.omega_h),
      pull(m.omega_v * m.omega_v * m.y0) {
  const SinCos<T> turn = sin_cos_turns(start.phase);
  r[0] = two_pi<T>() * m.H * turn.sin;
  c[0] = k2 * m.H * turn.cos;
  u[0] = d[1] = start.u;
  d[0] = T(0.0);
  X[0] = start.X;
  X[1] = start.u - eta;
  c[1] = -k2 * r[0] * u[0];
  inertia = m.mobility / (T(1.0) + r[0] * r[0]);
  r_inertia = r[0] * inertia;
  const T r1 = c[0] * u[0], fall = u[0] * r1;
  finish_order<0>(r1, (c[0] - pull) - fall, fall, inertia * (-wh2 * X[0]));
}

// r and u are known to order n, c and X to n + 1, lambda to n - 1. The last to be known, u[n] and lambda[n - 1], come
// in last.
template <class T>
template <std::size_t n>
void SlideOrders<T>::add_order() {
  using std::fma;
  const T newest = T(static_cast<double>(n + 2)) * r[1];  // as r[1] = c[0] u[0]
  const T r1 = fma(c[n], u[0], inner_product<n>(c, u));
  const T fall = fma(u[0], r1, T(static_cast<double>(n + 1)) * older_product<n + 1>(r, u));
  T pulled = inertia * fma(r[n], lambda[0], older_product<n>(r, lambda) - wh2 * X[n]);
  if constexpr (n > 1) pulled = fma(inertia * r[1], lambda[n - 1], pulled);
  finish_order<n>(fma(c[0], u[n], r1), fma(-newest, u[n], c[n] - fall), fma(newest, u[n], fall), pulled);
}

// Of order n: r' = c u; lambda and (r u)' without r[0] x''; inertia times x'' without r[0] lambda. x'' and lambda, of
// which either has the other beside r[0], follow.
template <class T>
template <std::size_t n>
void SlideOrders<T>::finish_order(const T& r1, const T& rest, const T& fall, const T& pulled) {
  using std::fma;
  constexpr double kFirst = static_cast<double>(n + 1), kPerSecond = 1.0 / static_cast<double>(n + 2);
  const T a = fma(r_inertia, rest, pulled), y2 = fma(r[0], a, fall);
  lambda[n] = fma(-r[0], a, rest);
  if constexpr (n < kSlideOrder) {
    u[n + 1] = a * T(1.0 / kFirst);
    r[n + 1] = r1 * T(1.0 / kFirst);
    if constexpr (n + 2 <= kSlideOrder) {
      c[n + 2] = -k2 * y2 * T(kPerSecond / kFirst);
      d[n + 2] = X[n + 2] = u[n + 1] * T(kPerSecond);
    }
    add_order<n + 1>();
  }
}

template <class T>
SlideSeries<T>::SlideSeries(const Mechanics<T>& m, const T& eta, const SlideState<T>& start) {
  SlideOrders<T>(m, eta, start, *this);
}

}  // namespace afm
