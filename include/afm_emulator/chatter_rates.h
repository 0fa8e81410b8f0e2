// How a tip that bounces quickly under a pressing surface changes on average: the flow that passes through its bounces.
//
// At the distance rho from the surface, s along it: rho'' = -P - K rho while it flies, with the reaction P of the slide
// that it would make instead (its guide). A bounce of normal speed v lasts 2 v/P and keeps the action
// v^3/P (1 - K v^2 / 5 P^2); it ends in v -> v (1 - w), w = (1 - gamma) v / v_c, at and above the cutoff in
// v -> gamma v. The flow that interpolates w -> w (1 - w) is dv/dn = -v w G(w), dt/dn = 2 v/P T(w), so
//   dv/dt = -(P/2) w R(w) + v P'/(3 P T(w)),   R = G/T.
// While it bounces the tip is off its guide by sigma, as the forces differ at its mean height v^2/(3 P), and this
// changes P. Kept are all terms of the second order of a bounce's duration against every change, for any w; what is
// left out is of the third.
#pragma once

#include <array>

#include "afm_emulator/flight.h"
#include "afm_emulator/model.h"
#include "afm_emulator/slide.h"

namespace afm {

struct Chatter {
  double v;            // normal speed after a bounce [a/tau]
  double n;            // bounces since the burst began; whole at a bounce
  double sigma = 0.0;  // at a bounce: from the guide, along the surface [a]
  double p = 0.0;      // and faster along it [a/tau]
  double drift = 0.0;  // time integral of how far x is from the guide's, bounces and all [a tau]
  double lift = 0.0;   // energy that the holder of a held tip has given the bounces: of the gap times P' [m a^2/tau^2]
};

// The same in variables that change evenly, so that an integrator can take long steps: with a cutoff v falls and n
// grows like exponentials of each other, n = rest + v_c / ((1 - gamma) v), and x = ln v; without one v falls evenly,
// x = v, and n goes like its logarithm.
struct EvenChatter {
  double x, rest, sigma, p, drift, lift;
};

inline EvenChatter operator+(const EvenChatter& a, const EvenChatter& b) {
  return {a.x + b.x, a.rest + b.rest, a.sigma + b.sigma, a.p + b.p, a.drift + b.drift, a.lift + b.lift};
}
inline EvenChatter operator*(double k, const EvenChatter& c) {
  return {k * c.x, k * c.rest, k * c.sigma, k * c.p, k * c.drift, k * c.lift};
}

// What the bounces see, at one time of the guide.
struct ChatterSurroundings {
  double P, per_P;   // reaction [a/tau^2]
  double squeeze;    // of v by itself: P'/3P
  double stretch;    // times v^2: of the duration of a bounce, by what the reaction does in it
  double twist;      // times v^3: of dv/dt, likewise
  double lag;        // times w v^2: of dv/dt, as a loss is at the end of its bounce
  double turn;       // of the surface under the tip: curvature times speed
  double lean;       // times rho: of the acceleration along the surface by height; minus dP/ds
  double stiffness;  // times -sigma: of it by place
  double along, up;  // x off the guide for each sigma and rho
  double quickness;  // of the changes of P [1/tau]
  double speed;      // |u| [a/tau]
  double slow_rate;  // of the changes of the slope and of the springs [turns/tau]
};

// In the middle and at the end of a step.
struct ChatterAhead {
  ChatterSurroundings middle, end;
};

class ChatterRates {
 public:
  // geometric: without regard to the cutoff, as if it were 0
  ChatterRates(const Model& model, bool geometric);

  ChatterSurroundings surroundings(const SlidePiece<double>& guide, double s) const;
  ChatterAhead ahead(const SlidePiece<double>& guide, double s, double dt) const;
  // P, squeeze, quickness, speed and slow_rate alone, at the start of a bounce that is no chatter yet.
  ChatterSurroundings surroundings(const Flight<double>& bounce) const;

  EvenChatter even(const ChatterSurroundings& at, const Chatter& c) const;
  Chatter plain(const ChatterSurroundings& at, const EvenChatter& c) const;

  // d/dt. In `c` v stands for what it would be on the guide itself.
  EvenChatter operator()(const ChatterSurroundings& at, const EvenChatter& c) const;
  // Over dt, by the classical Runge-Kutta method: from the rate at its beginning and what is seen later.
  EvenChatter step(double dt, const EvenChatter& rate, const ChatterAhead& ahead, const EvenChatter& c) const;

  // The time in which v falls by the factor e, or, evenly, to nothing, through the losses alone [tau].
  double fall_time(const ChatterSurroundings& at, double v) const;
  double x_of(double v) const;  // where nothing is off the guide

  double loss(double v) const { return loss_ * v; }  // w

 private:
  ChatterSurroundings look(const SlideState<double>& q, const std::array<double, 4>& pressure) const;
  EvenChatter rate(const ChatterSurroundings& at, const EvenChatter& c) const;
  double speed(double x) const;
  double bounces_at(double v) const;

  bool geometric_;
  double gamma_, H_, wv2_, free_, wh2_, slow_rate_;
  double loss_;  // (1 - gamma) / v_c
  double even_;  // n's part in v: 1 / loss, or 1 / -log(gamma)
  double per_mean_;  // (1 - gamma) / -log(gamma): mean of a bounce's v over its first
};

// The guide with what the chatter has moved it by.
SlideState<double> moved_guide(const Model& model, const SlideState<double>& guide, const Chatter& chatter);

}  // namespace afm
