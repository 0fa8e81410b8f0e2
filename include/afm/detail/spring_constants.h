// The constants of springs and surface in the number type of a computation, and the smallest force that counts as a
// release.
#pragma once

#include <algorithm>
#include <cmath>

#include "afm/model.h"
#include "select.h"
#include "turns.h"

namespace afm {

template <class T>
struct SpringConstants {
  explicit SpringConstants(const Model& model)
      : is_free_along_x(afm::is_free_along_x(model)),
        ratio(is_free_along_x * T(model.frequency_ratio)),
        omega_v(two_pi<T>()),
        omega_h(omega_v * ratio),
        H(model.H),
        y0(model.y0),
        inverse_omega_v(T(1.0) / omega_v),
        inverse_omega_h(afm::is_free_along_x(model) > 0.0 ? T(1.0) / omega_h : T(0.0)) {}

  // w / omega, exact beyond the last digit. With a rounded 1 / omega every turn of a spring would add or remove energy.
  static T divide_by_omega(const T& w, const T& omega, const T& per) {
    return mul_add(w, per, T((w * per) * mul_add(T(-omega), per, T(1.0))));
  }

  T is_free_along_x;  // 1, or 0 for the hammer, whose horizontal spring then has no length and no force
  T ratio, omega_v, omega_h, H, y0;
  T inverse_omega_v, inverse_omega_h;  // products are faster than quotients
};

// The smallest pull that counts as a release [a/tau^2]; a smaller one is rounding. Without it the glide at eta = 1,
// whose reaction is zero for ever, would be released and caught at every rounding. It delays a release by 1e-11 tau. If
// the terms of the reaction exceed 1e4, as with mica's springs above 50 a/tau, it is a part of them.
constexpr double kReleaseNoise = 1e-9;

template <class T>
T release_noise(const SpringConstants<T>& m, const T& u, const T& X) {
  using std::abs;
  using std::max;
  constexpr double kRelativeNoise = 1e-13;  // of the terms: each sum of a slide's series has an error of 3e-14
  const T k = m.omega_v, turning = k * k * m.H * (T(1.0) + u * u), rest = k * k * abs(m.y0);
  return max(T(kReleaseNoise), T(kRelativeNoise) * (turning + rest + k * m.H * (m.omega_h * m.omega_h) * abs(X)));
}

}  // namespace afm
