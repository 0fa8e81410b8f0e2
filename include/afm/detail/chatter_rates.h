// How a tip that bounces quickly under a pressing surface changes on average: the flow that passes through its bounces.
//
// At the distance rho from the surface, s along it: rho'' = -P - K rho while it flies, with the reaction P of the slide
// that it would make instead (its reference slide). A bounce of normal speed v lasts 2 v/P and keeps the action
// v^3/P (1 - K v^2 / 5 P^2); it ends in v -> v (1 - w), w = (1 - gamma) v / v_c, at and above the cutoff in
// v -> gamma v. The flow that interpolates w -> w (1 - w) is dv/dn = -v w G(w), dt/dn = 2 v/P T(w), so
//   dv/dt = -(P/2) w R(w) + v P'/(3 P T(w)) (1 - w^2 S(w)),   R = G/T.
// While it bounces the tip is off its reference slide by sigma, as the forces differ at its mean height v^2/(3 P), and this
// changes P. Kept are all terms of the third order of w and of a bounce's duration against every change, by computer
// algebra (docs/derive_chatter_law.py); of what moves it off the reference slide, and without a cutoff, those of the second.
#pragma once

#include "chatter_geometry.h"

namespace afm {

template <class T>
struct ChatterOf {
  T v;               // normal speed after a bounce [a/tau]
  T n;               // bounces since the burst began; whole at a bounce
  T sigma = T(0.0);  // at a bounce: from the guide, along the surface [a]
  T p = T(0.0);      // and faster along it [a/tau]
  T drift = T(0.0);  // time integral of how far x is from the guide's, bounces and all [a tau]
  T lift = T(0.0);   // energy that the holder of a held tip has given the bounces: of the gap times P' [m a^2/tau^2]
};
using Chatter = ChatterOf<double>;

// The same in variables that change evenly, so that an integrator can take long steps: with a cutoff v falls and n
// grows like exponentials of each other, n = rest + v_c / ((1 - gamma) v), and x = ln v; where v hardly falls in a step
// but with the pressure, n = rest. Without a cutoff v falls evenly, x = v, and n goes like its logarithm.
template <class T>
struct SmoothChatterOf {
  T x, rest, sigma, p, drift, lift;
};
using SmoothChatter = SmoothChatterOf<double>;

template <class T>
SmoothChatterOf<T> operator+(const SmoothChatterOf<T>& a, const SmoothChatterOf<T>& b) {
  return {a.x + b.x, a.rest + b.rest, a.sigma + b.sigma, a.p + b.p, a.drift + b.drift, a.lift + b.lift};
}
template <class T>
SmoothChatterOf<T> operator*(const T& k, const SmoothChatterOf<T>& c) {
  return {k * c.x, k * c.rest, k * c.sigma, k * c.p, k * c.drift, k * c.lift};
}

// On the way along the reference slide.
struct ChatterPlace {
  double s;  // time of the guide
  ChatterSurroundings around;
  SmoothChatter even, rate;
  Chatter plain;
  double part;  // times 1/v, of n: what `even` and `rate` are without
};

// How long a bounce lasts there [tau].
inline double duration(const ChatterPlace& at) { return 2.0 * at.plain.v * at.around.inverse_P; }

// What the rates ask of a model.
struct ChatterFlow {
  bool geometric, held;  // without regard to the cutoff; along x
  double gamma;
  double loss;          // (1 - gamma) / v_c
  double even;          // n's part in v: 1 / loss, or 1 / -log(gamma)
  double inverse_mean;  // (1 - gamma) / -log(gamma): mean of a bounce's v over its first
};

class ChatterRates {
 public:
  // geometric: without regard to the cutoff, as if it were 0
  ChatterRates(const Model& model, bool geometric);

  ChatterSurroundings surroundings(const Flight<double>& bounce) const;
  ChatterSurroundings surroundings(const SlideSegment<double>& reference, double s) const;
  bool certainly_outlasts(const Flight<double>& bounce, double part) const;  // as ChatterView

  ChatterPlace begin(const SlideSegment<double>& reference, double s, const Chatter& start) const;
  // Over dt, by Lobatto's method of order 8, its equations solved by iteration. Where it goes too far the numbers may
  // be none.
  ChatterPlace step(const SlideSegment<double>& reference, const ChatterPlace& from, double dt) const;
  // The same over no more than a bounce or two, forwards or back, by the mean of two rates: good to the second order.
  ChatterPlace brief_step(const SlideSegment<double>& reference, const ChatterPlace& from, double dt) const;
  // By so little that what the rates change by in it is nothing.
  Chatter after(const ChatterPlace& from, double dt) const;

  // The time in which v falls by the factor e, or, evenly, to nothing, through the losses alone [tau].
  double fall_time(const ChatterSurroundings& at, double v) const;
  double x_of(double v) const;  // where nothing is off the guide

  double loss(double v) const { return flow_.loss * v; }  // w
  const ChatterFlow& flow() const { return flow_; }
  const ChatterGeometry& view() const { return view_; }
  bool held() const { return view_.held(); }

 private:
  void take_part(double more, SmoothChatter& even, SmoothChatter& rate) const;

  ChatterGeometry view_;
  ChatterFlow flow_;
};

// The guide with what the chatter has moved it by.
SlideState<double> moved_reference(const Model& model, const SlideState<double>& reference, const Chatter& chatter);

}  // namespace afm
