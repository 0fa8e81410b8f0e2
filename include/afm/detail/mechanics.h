// The constants of the springs and the surface as a computation uses them, and the least force that counts there.
#pragma once

#include <algorithm>
#include <cmath>

#include "afm/model.h"
#include "select.h"
#include "turns.h"

namespace afm {

// The constants of one model in the number type of the computation.
template <class T>
struct Mechanics {
  Mechanics() = default;
  explicit Mechanics(const Model& model)
      : is_free_along_x(afm::is_free_along_x(model)),
        ratio(is_free_along_x * T(model.frequency_ratio)),
        omega_v(two_pi<T>()),
        omega_h(omega_v * ratio),
        H(model.H),
        y0(model.y0),
        inverse_omega_v(T(1.0) / omega_v),
        inverse_omega_h(afm::is_free_along_x(model) > 0.0 ? T(1.0) / omega_h : T(0.0)) {}

  // w / omega to more than the last digit: w times a rounded 1 / omega would add energy at every turn, or take it away.
  static T turned(const T& w, const T& omega, const T& per) {
    return mul_add(w, per, T((w * per) * mul_add(T(-omega), per, T(1.0))));
  }

  T is_free_along_x;  // 0: held along x, as if there were no horizontal spring and nothing to stretch it
  T ratio, omega_v, omega_h, H, y0;
  T inverse_omega_v, inverse_omega_h;  // a product is faster than a quotient
};

// A pull of the surface smaller than this is rounding, not a release: without it the glide at eta = 1, where the
// reaction is nothing for ever, would be let go and caught again at every rounding. It moves a release by 1e-11 tau
// [a/tau^2]. Where the terms whose sum the pull is are above 1e4, as under mica's springs from 50 a/tau, it is a part
// of them.
constexpr double kReleaseNoise = 1e-9;

template <class T>
T release_noise(const Mechanics<T>& m, const T& u, const T& X) {
  using std::abs;
  using std::max;
  constexpr double kPart = 1e-13;  // of a slide's series, each sum is good to 3e-14
  const T k = m.omega_v, turning = k * k * m.H * (T(1.0) + u * u), rest = k * k * abs(m.y0);
  return max(T(kReleaseNoise), T(kPart) * (turning + rest + k * m.H * (m.omega_h * m.omega_h) * abs(X)));
}

}  // namespace afm
