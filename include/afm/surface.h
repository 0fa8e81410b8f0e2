// The surface h(x) = H cos(2 pi x) (paper, section III), crest at x = 0 [a].
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
inline double wrap_phase(double x) {
  if (x > 0.0 && x < 1.0) return x;  // most are: a predicted branch is faster than the rounding
  const double phase = x - std::floor(x);
  return phase < 1.0 ? phase : 0.0;
}

}  // namespace afm
