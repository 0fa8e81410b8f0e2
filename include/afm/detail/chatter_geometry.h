// What quick bounces see of the surface that presses on them, at one time of the slide that they follow.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "afm/contact.h"
#include "afm/flight.h"
#include "afm/model.h"

namespace afm {

// The coefficients c_... of the averaged law (chatter_rates.h); src/core/contact/chatter_geometry.h has the formula of each.
template <class T>
struct ChatterSurroundingsOf {
  T P, inverse_P;   // reaction [a/tau^2]
  T P1, P2, P3;     // its time derivatives
  T bend, K1;    // K, by which the reaction grows with height, and its rate
  T c_speed;        // of v in dv/dt: P'/3P
  T c_duration;     // of v^2 in the duration of a bounce over 2 v/P
  T c_speed3;       // of v^3 in dv/dt
  T c_loss;         // of v^2 in the loss of a bounce over w: it loses v at its end
  T c_loss_w;       // of w v^2 in the same
  T turn;           // of the surface under the tip: curvature times speed
  T c_height;       // of rho in the acceleration along the surface: minus dP/ds
  T stiffness;      // of -sigma in the same
  T along, up;      // x off the reference slide for each sigma and rho
  T relative_rate;  // of the changes of P [1/tau]
  T speed;          // |u| [a/tau]
  T slow_rate;      // of the changes of the slope and of the springs [turns/tau]
};
using ChatterSurroundings = ChatterSurroundingsOf<double>;

// The time in which the pressure falls by a part of itself, from its value and first two derivatives; infinite where it
// does not.
inline double time_to_fall(const ChatterSurroundings& at, double part) {
  const double rate = -3.0 * at.c_speed, bend = rate * rate - 2.0 * part * at.P2 * at.inverse_P;
  const double twice_inverse = rate + std::sqrt(std::max(0.0, bend));
  return bend >= 0.0 && twice_inverse > 0.0 ? 2.0 * part / twice_inverse : std::numeric_limits<double>::infinity();
}

class ChatterGeometry {
 public:
  explicit ChatterGeometry(const Model& model);

  // Internal, inlined where they are used: src/core/chatter_geometry.h.
  template <class T>
  ChatterSurroundingsOf<T> look(const SlideSegment<T>& reference, const T& time) const;
  // P, c_speed, relative_rate, speed and slow_rate alone, at the start of a bounce that is no chatter yet.
  ChatterSurroundings look(const Flight<double>& bounce) const;
  // Whether such a bounce certainly lasts longer than `part` of the time in which P changes, by P' alone: faster.
  bool certainly_outlasts(const Flight<double>& bounce, double part) const;

  bool held() const { return free_ == 0.0; }  // along x

 private:
  double H_, wv2_, free_, wh2_, slow_rate_;
};

}  // namespace afm
