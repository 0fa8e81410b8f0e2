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

// The same with terms n - 1, without terms n.
template <std::size_t n, class T>
T inner_product(const Series<T>& a, const Series<T>& b) {
  using std::fma;
  if constexpr (n < 2) return T(0.0);
  if constexpr (n == 2) return a[1] * b[1];
  if constexpr (n > 2) return fma(a[1], b[n - 1], fma(a[n - 1], b[1], early_product<n>(a, b)));
}

// Coefficient n of the product of two series.
template <std::size_t n, class T>
T product(const Series<T>& a, const Series<T>& b) {
  using std::fma;
  if constexpr (n == 0) return a[0] * b[0];
  if constexpr (n > 0) return fma(a[0], b[n], fma(a[n], b[0], inner_product<n>(a, b)));
}

// With r = -h', c = -h'' and the reaction lambda (of the surface on a tip of mass 1, along y): x'' = -omega_h^2 X + r
// lambda and lambda = q - r x'', where q = omega_v^2 (h - y0) - c x'^2; as omega_v is the surface's wave number too,
// omega_v^2 h = c.
template <class T>
struct SlideSeries {
  SlideSeries(const Mechanics<T>& m, const T& eta, const SlideState<T>& start);

  Series<T> d{}, u{}, lambda{};  // x - x(start), x', reaction

 private:
  template <std::size_t n>
  void add_order();

  T k2, wh2, inertia, pull, r_inertia;
  Series<T> r{}, c{}, X{}, r1{}, a{};  // of them r' = c x', a = x''
};

template <class T>
SlideSeries<T>::SlideSeries(const Mechanics<T>& m, const T& eta, const SlideState<T>& start)
    : k2(two_pi<T>() * two_pi<T>()), wh2(m.omega_h * m.omega_h), pull(m.omega_v * m.omega_v * m.y0) {
  const SinCos<T> turn = sin_cos_turns(start.phase);
  r[0] = two_pi<T>() * m.H * turn.sin;
  c[0] = k2 * m.H * turn.cos;
  u[0] = d[1] = start.u;
  X[0] = start.X;
  X[1] = start.u - eta;
  inertia = m.mobility / (T(1.0) + r[0] * r[0]);
  r_inertia = r[0] * inertia;
  add_order<0>();
}

// r, c and u are known to order n, X to order n + 1; x'' and lambda of order n follow from each other: lambda = rest -
// r x''.
template <class T>
template <std::size_t n>
void SlideSeries<T>::add_order() {
  using std::fma;
  // a[n] and lambda[n] are not known yet, and stand only beside r[0]
  T early = -wh2 * X[n], rest = c[n];
  if constexpr (n == 0) rest = rest - pull;
  if constexpr (n > 0) early = fma(r[n], lambda[0], inner_product<n>(r, lambda) + early);
  if constexpr (n > 0) rest = rest - fma(r[n], a[0], inner_product<n>(r, a));
  r1[n] = product<n>(c, u);
  if constexpr (n == 0) rest = fma(-u[0], r1[0], rest);
  if constexpr (n > 0) rest = fma(-u[0], r1[n], fma(-u[n], r1[0], rest - inner_product<n>(u, r1)));
  a[n] = fma(r_inertia, rest, inertia * early);
  lambda[n] = fma(-r[0], a[n], rest);
  if constexpr (n < kSlideOrder) {
    constexpr double kPerNext = 1.0 / static_cast<double>(n + 1), kPerSecond = 1.0 / static_cast<double>(n + 2);
    u[n + 1] = a[n] * T(kPerNext);
    r[n + 1] = r1[n] * T(kPerNext);
    c[n + 1] = -k2 * product<n>(r, u) * T(kPerNext);
    if constexpr (n + 2 <= kSlideOrder) d[n + 2] = X[n + 2] = u[n + 1] * T(kPerSecond);
    add_order<n + 1>();
  }
}

}  // namespace afm
