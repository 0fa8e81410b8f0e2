// What quick bounces see of the surface that presses on them, at one time of the slide that they follow.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "afm/flight.h"
#include "afm/model.h"
#include "afm/contact.h"

namespace afm {

template <class T>
struct ChatterSurroundingsOf {
  T P, per_P;     // reaction [a/tau^2]
  T P1, P2, P3;   // its time derivatives
  T bend, bend1;  // K, by which the reaction grows with height, and its rate
  T squeeze;      // of v by itself: P'/3P
  T stretch;      // times v^2: of the duration of a bounce, by what the reaction does in it
  T twist;        // times v^3: of dv/dt, likewise
  T lag, late;    // times v^2, and w v^2: of what a bounce loses, over w, as it loses it at its end
  T turn;         // of the surface under the tip: curvature times speed
  T lean;         // times rho: of the acceleration along the surface by height; minus dP/ds
  T stiffness;    // times -sigma: of it by place
  T along, up;    // x off the guide for each sigma and rho
  T quickness;    // of the changes of P [1/tau]
  T speed;        // |u| [a/tau]
  T slow_rate;    // of the changes of the slope and of the springs [turns/tau]
};
using ChatterSurroundings = ChatterSurroundingsOf<double>;

// The time in which the pressure falls by a part of itself, from its value and first two derivatives; infinite where it
// does not.
inline double time_to_fall(const ChatterSurroundings& at, double part) {
  const double rate = -3.0 * at.squeeze, bend = rate * rate - 2.0 * part * at.P2 * at.per_P;
  const double twice_per = rate + std::sqrt(std::max(0.0, bend));
  return bend >= 0.0 && twice_per > 0.0 ? 2.0 * part / twice_per : std::numeric_limits<double>::infinity();
}

class ChatterView {
 public:
  explicit ChatterView(const Model& model);

  // Internal, inlined where they are used: src/core/chatter_look.h.
  template <class T>
  ChatterSurroundingsOf<T> look(const SlidePiece<T>& guide, const T& time) const;
  // P, squeeze, quickness, speed and slow_rate alone, at the start of a bounce that is no chatter yet.
  ChatterSurroundings look(const Flight<double>& bounce) const;
  // Whether such a bounce certainly lasts longer than `part` of the time in which P changes, by P' alone: sooner told.
  bool outlasts(const Flight<double>& bounce, double part) const;

  bool held() const { return free_ == 0.0; }  // along x

 private:
  double H_, wv2_, free_, wh2_, slow_rate_;
};

}  // namespace afm
