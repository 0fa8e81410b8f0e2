// What fast bounces experience of the surface along the reference slide: its reaction, and the coefficients of the
// averaged law (docs/algorithm.md, "Chatter"). The hammer is held along x: its slope counts as zero, only the reaction
// acts.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "afm/contact.h"
#include "afm/flight.h"
#include "afm/model.h"

namespace afm {

// src/core/contact/chatter_geometry.h has the formula of each.
template <class T>
struct ChatterSurroundingsOf {
  T P, inverse_P;   // reaction normal to the surface [a/tau^2]
  T P1, P2, P3;     // time derivatives of P
  T K, K1;          // growth of the reaction with the distance from the surface [1/tau^2], and its time derivative
  T c_speed;        // coefficient of v in dv/dt: P'/3P [1/tau]
  T c_duration;     // of v^2 in the duration of a bounce over 2 v/P
  T c_speed3;       // of v^3 in dv/dt
  T c_loss;         // of v^2 in the loss of a bounce over w v: the bounce loses speed at its end
  T c_loss_w;       // of w v^2 in the same
  T turn_rate;      // of the surface under the tip: curvature times speed [rad/tau]
  T c_height;       // of rho in the acceleration along the surface: minus dP/ds [1/tau^2]
  T c_sigma;        // of -sigma in the acceleration along the surface [1/tau^2]
  T x_per_sigma;    // displacement along x for a displacement along the surface
  T x_per_rho;      // displacement along x for a distance from the surface
  T relative_rate;  // relative rate of change of P [1/tau]
  T slow_rate;      // of the changes of the slope and of the springs [turns/tau]
};
using ChatterSurroundings = ChatterSurroundingsOf<double>;

// The time in which the reaction falls by `part` of itself [tau], from its value and first two derivatives. Infinite if
// it does not fall so far.
inline double time_to_fall(const ChatterSurroundings& at, double part) {
  const double rate = -3.0 * at.c_speed, bend = rate * rate - 2.0 * part * at.P2 * at.inverse_P;
  const double twice_inverse = rate + std::sqrt(std::max(0.0, bend));
  return bend >= 0.0 && twice_inverse > 0.0 ? 2.0 * part / twice_inverse : std::numeric_limits<double>::infinity();
}

class ChatterGeometry {
 public:
  explicit ChatterGeometry(const Model& model);

  // Internal and inlined: the definitions stand in src/core/contact/chatter_geometry.h.
  template <class T>
  ChatterSurroundingsOf<T> surroundings(const SlideSegment<T>& reference, const T& time) const;
  // At the start of a bounce, before chatter begins: P, inverse_P, c_speed, relative_rate and slow_rate only.
  ChatterSurroundings surroundings(const Flight<double>& bounce) const;
  // True: such a bounce certainly lasts longer than `part` of the time in which P changes. Uses P' alone, so it is
  // faster.
  bool certainly_outlasts(const Flight<double>& bounce, double part) const;

  bool is_held_along_x() const { return free_ == 0.0; }

 private:
  double H_, wv2_, free_, wh2_, slow_rate_;
};

}  // namespace afm
