// What quick bounces see of the surface that presses on them, at one time of the slide that they follow.
#pragma once

#include <cstddef>

#include "afm_emulator/flight.h"
#include "afm_emulator/model.h"
#include "afm_emulator/slide.h"

namespace afm {

struct ChatterSurroundings {
  double P, per_P;     // reaction [a/tau^2]
  double P1, P2, P3;   // its time derivatives
  double bend, bend1;  // K, by which the reaction grows with height, and its rate
  double squeeze;      // of v by itself: P'/3P
  double stretch;      // times v^2: of the duration of a bounce, by what the reaction does in it
  double twist;        // times v^3: of dv/dt, likewise
  double lag;          // times w v^2: of dv/dt, as a loss is at the end of its bounce
  double turn;         // of the surface under the tip: curvature times speed
  double lean;         // times rho: of the acceleration along the surface by height; minus dP/ds
  double stiffness;    // times -sigma: of it by place
  double along, up;    // x off the guide for each sigma and rho
  double quickness;    // of the changes of P [1/tau]
  double speed;        // |u| [a/tau]
  double slow_rate;    // of the changes of the slope and of the springs [turns/tau]
};

class ChatterView {
 public:
  explicit ChatterView(const Model& model);

  // Internal, inlined where they are used: src/core/chatter_look.h.
  ChatterSurroundings look(const SlidePiece<double>& guide, double s) const;
  // P, squeeze, quickness, speed and slow_rate alone, at the start of a bounce that is no chatter yet.
  ChatterSurroundings look(const Flight<double>& bounce) const;
  // Whether such a bounce certainly lasts longer than `part` of the time in which P changes, by P' alone: sooner told.
  bool outlasts(const Flight<double>& bounce, double part) const;
  // At an inner node of a step of which both ends are known, without the last three. The reaction is interpolated to the
  // order 8, what is only in terms of the second order evenly.
  ChatterSurroundings between(const ChatterSurroundings& first, const ChatterSurroundings& last, double dt,
                              std::size_t node) const;

  bool held() const { return free_ == 0.0; }  // along x

 private:
  double H_, wv2_, free_, wh2_, slow_rate_;
};

}  // namespace afm
