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

// (1 + h'^2) x'' = -omega_h^2 X - h' q with q = omega_v^2 (h - y0) + h'' x'^2; the pressure is minus the acceleration that
// the gap would have in free flight, q - h' omega_h^2 X.
template <class T>
struct SlideSeries {
  SlideSeries(const Mechanics<T>& m, const T& eta, const SlideState<T>& start);

  Series<T> d{}, u{}, p{};  // x - x(start), x', pressure

 private:
  template <std::size_t n>
  void add_order();

  T k, H, wv2, wh2, y0, inertia;
  Series<T> S{}, C{}, X{}, u2{}, q{}, slope2{}, a{};  // sine, cosine, extension, u^2, q, h'^2 less its constant, x''
};

template <class T>
SlideSeries<T>::SlideSeries(const Mechanics<T>& m, const T& eta, const SlideState<T>& start)
    : k(two_pi<T>()), H(m.H), wv2(m.omega_v * m.omega_v), wh2(m.omega_h * m.omega_h), y0(m.y0) {
  const SinCos<T> turn = sin_cos_turns(start.phase);
  S[0] = turn.sin;
  C[0] = turn.cos;
  u[0] = d[1] = start.u;
  X[0] = start.X;
  X[1] = start.u - eta;
  inertia = m.mobility / (T(1.0) + k * k * H * H * turn.sin * turn.sin);
  add_order<0>();
}

// S, C and u are known to order n, X to order n + 1.
template <class T>
template <std::size_t n>
void SlideSeries<T>::add_order() {
  u2[n] = product<n>(u, u);
  if constexpr (n > 0) slope2[n] = k * k * H * H * product<n>(S, S);
  q[n] = H * (wv2 * C[n] - k * k * product<n>(C, u2));
  if constexpr (n == 0) q[0] = q[0] - wv2 * y0;
  p[n] = q[n] + k * H * wh2 * product<n>(S, X);
  if constexpr (n < kSlideOrder) {
    T force = k * H * product<n>(S, q) - wh2 * X[n];
    if constexpr (n > 0) force = force - product<n>(slope2, a);
    a[n] = force * inertia;
    u[n + 1] = a[n] / T(static_cast<double>(n + 1));
    S[n + 1] = k * product<n>(u, C) / T(static_cast<double>(n + 1));
    C[n + 1] = -k * product<n>(u, S) / T(static_cast<double>(n + 1));
    if constexpr (n + 2 <= kSlideOrder) d[n + 2] = X[n + 2] = u[n + 1] / T(static_cast<double>(n + 2));
    add_order<n + 1>();
  }
}

}  // namespace afm
