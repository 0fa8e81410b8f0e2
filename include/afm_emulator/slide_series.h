// The Taylor series of a slide: each order follows from those before by products of series. The orders are unrolled when
// compiled, and each product takes the newest terms last, so that the rest of it need not wait for them.
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

constexpr std::size_t kSlideOrder = 16;

template <class T>
using Series = std::array<T, kSlideOrder + 1>;

template <class T>
T horner(const Series<T>& c, const T& s) {
  using std::fma;
  T sum = c[kSlideOrder];
  for (std::size_t k = kSlideOrder; k-- > 0;) sum = fma(sum, s, c[k]);
  return sum;
}

// Coefficient n of the product of two series.
template <std::size_t n, class T>
T product(const Series<T>& a, const Series<T>& b) {
  using std::fma;
  if constexpr (n == 0) {
    return a[0] * b[0];
  } else {
    T even(0.0), odd(0.0);
#pragma GCC unroll 32
    for (std::size_t k = 1; k + 1 < n; k += 2) {
      odd = fma(a[k], b[n - k], odd);
      even = fma(a[k + 1], b[n - k - 1], even);
    }
    if constexpr (n % 2 == 0) odd = fma(a[n - 1], b[1], odd);
    return fma(a[0], b[n], fma(a[n], b[0], odd + even));
  }
}

// With the reaction lambda (of the surface on a tip of mass 1, along y): x'' = -omega_h^2 X - h' lambda and
// lambda = q + h' x'', where q = omega_v^2 (h - y0) + h'' x'^2.
template <class T>
struct SlideSeries {
  SlideSeries(const Mechanics<T>& m, const T& eta, const SlideState<T>& start);

  Series<T> d{}, u{}, lambda{};  // x - x(start), x', reaction

 private:
  template <std::size_t n>
  void add_order();

  T k, H, wv2, wh2, y0, mobility, inertia;
  Series<T> S{}, C{}, X{}, uC{}, a{};  // sine, cosine, extension, x' times cosine, x''
};

template <class T>
SlideSeries<T>::SlideSeries(const Mechanics<T>& m, const T& eta, const SlideState<T>& start)
    : k(two_pi<T>()),
      H(m.H),
      wv2(m.omega_v * m.omega_v),
      wh2(m.omega_h * m.omega_h),
      y0(m.y0),
      mobility(m.mobility) {
  const SinCos<T> turn = sin_cos_turns(start.phase);
  S[0] = turn.sin;
  C[0] = turn.cos;
  u[0] = d[1] = start.u;
  X[0] = start.X;
  X[1] = start.u - eta;
  inertia = mobility / (T(1.0) + k * k * H * H * turn.sin * turn.sin);
  add_order<0>();
}

// S, C and u are known to order n, X to order n + 1; x'' and lambda of order n follow from each other: lambda = rest + h' x''.
template <class T>
template <std::size_t n>
void SlideSeries<T>::add_order() {
  uC[n] = product<n>(u, C);
  T rest = H * (wv2 * C[n] - k * k * product<n>(u, uC));
  if constexpr (n == 0) rest = rest - wv2 * y0;
  // a[n] and lambda[n] are still 0 in these products
  if constexpr (n > 0) rest = rest - k * H * product<n>(S, a);
  T push = rest * S[0];
  if constexpr (n > 0) push = push + product<n>(S, lambda);
  a[n] = (k * H * push - wh2 * X[n]) * inertia;
  lambda[n] = rest - k * H * S[0] * a[n];
  if constexpr (n < kSlideOrder) {
    u[n + 1] = a[n] / T(static_cast<double>(n + 1));
    S[n + 1] = k * uC[n] / T(static_cast<double>(n + 1));
    C[n + 1] = -k * product<n>(u, S) / T(static_cast<double>(n + 1));
    if constexpr (n + 2 <= kSlideOrder) d[n + 2] = X[n + 2] = u[n + 1] / T(static_cast<double>(n + 2));
    add_order<n + 1>();
  }
}

}  // namespace afm
