// The Taylor series of a slide about a state: what it begins with, and sums of it.
#pragma once

#include <array>
#include <cmath>

#include "mechanics.h"
#include "slide_orders.h"

namespace afm {

// On the surface, moving along it.
template <class T>
struct SlideState {
  T phase, X, u;
};

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

// Powers of the time since the start.
template <class T>
struct SlideSeries {
  Series<T> d, u, lambda;  // x - x(start), x', reaction
};

template <class T>
SlideBeginning<T> slide_beginning(const Mechanics<T>& m, const T& eta, const SlideState<T>& start) {
  const SinCos<T> turn = sin_cos_turns(start.phase);
  const T k = two_pi<T>(), r = k * m.H * turn.sin, inertia = m.mobility / (T(1.0) + r * r);
  return {r,       k * k * m.H * turn.cos,           start.u, start.X, start.u - eta, m.omega_v * m.omega_v * m.y0,
          inertia, inertia * (m.omega_h * m.omega_h)};
}

// How the orders are written: with three numbers side by side in a register, or in this.
template <class T>
void write_slide_orders(const SlideBeginning<T>& start, T* d, T* u, T* lambda) {
  SlideOrders<T, Three<T>>(start, d, u, lambda);
}

}  // namespace afm
