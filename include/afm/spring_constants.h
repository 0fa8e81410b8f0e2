// The constants of springs and surface in the number type of a computation.
#pragma once

#include "afm/detail/turns.h"
#include "model.h"

namespace afm {

template <class T>
struct SpringConstants {
  explicit SpringConstants(const Model& model)
      : is_free_along_x(afm::is_free_along_x(model)),
        ratio(is_free_along_x * T(model.frequency_ratio)),
        omega_v(detail::two_pi<T>()),
        omega_h(omega_v * ratio),
        H(model.H),
        y0(model.y0),
        inverse_omega_v(T(1.0) / omega_v),
        inverse_omega_h(afm::is_free_along_x(model) > 0.0 ? T(1.0) / omega_h : T(0.0)) {}

  T is_free_along_x;   // 1, or 0 for the hammer, whose horizontal spring then has no length and no force
  T ratio;             // omega_h / omega_v
  T omega_v, omega_h;  // [rad/tau]
  T H, y0;             // [a]
  T inverse_omega_v, inverse_omega_h;  // products are faster than quotients
};

}  // namespace afm
