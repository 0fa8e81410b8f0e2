// The mica surface h(x) = H cos(2 pi x) (paper, section III), crest at x = 0 [a].
#pragma once

#include <cmath>

#include "afm/detail/turns.h"

namespace afm {

// Height [a] and its derivatives by x at one phase.
template <class T>
struct SurfaceJet {
  T h, h1, h2, h3;
};

template <class T>
inline SurfaceJet<T> surface_jet(const T& H, const T& phase) {
  using detail::sin_cos_turns;
  const detail::SinCos<T> turn = sin_cos_turns(phase);
  const T k = detail::two_pi<T>();
  const T h = H * turn.cos;
  const T h1 = -k * H * turn.sin;
  return {h, h1, -k * k * h, -k * k * h1};
}

// x mod 1 in [0, 1).
template <class T>
T wrapped(const T& x) {
  using std::floor;
  const T phase = x - floor(x);
  return phase < T(1.0) ? phase : T(0.0);
}
// Most phases are in the interval already, and a predicted branch is faster than the rounding.
inline double wrapped(double x) { return x > 0.0 && x < 1.0 ? x : wrapped<double>(x); }
inline double wrap_phase(double x) { return wrapped(x); }

}  // namespace afm
