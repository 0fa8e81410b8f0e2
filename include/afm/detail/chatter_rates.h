// The averaged law of chatter: the flow that passes through the bounces of a tip under a pressing surface
// (docs/algorithm.md, "Chatter"; docs/derive_chatter_law.py derives the series).
//
// At the distance rho from the surface the tip obeys rho'' = -P - K rho while it flies. P is the reaction along the
// reference slide, the slide that the tip would make without bouncing. A bounce of normal speed v lasts 2 v/P and keeps
// the action v^3/P (1 - K v^2 / 5 P^2). The impact at its end takes v to v (1 - w). Below the cutoff
// w = (1 - gamma) v / v_c; at and above it w = 1 - gamma. The flow that interpolates w -> w (1 - w) is
//   dv/dn = -v w G(w),   dt/dn = 2 v/P T(w),
//   dv/dt = -(P/2) w R(w) + v P'/(3 P T(w)) (1 - w^2 S(w)),   R = G/T.
// At the mean height v^2/(3 P) of a bounce the forces differ from those on the reference slide. So the tip is displaced
// from it by sigma, which changes P. We keep all terms up to the third order of w, and of a bounce's duration over the
// times of all changes. Of the displacement, and without a cutoff, we keep the second order.
#pragma once

#include "chatter_geometry.h"

namespace afm {

template <class T>
struct ChatterOf {
  T v;                   // normal speed after a bounce [a/tau]
  T n;                   // bounces since the sequence began; whole at a bounce
  T sigma = T(0.0);      // displacement from the reference slide along the surface, at a bounce [a]
  T p = T(0.0);          // speed along the surface beyond that of the reference slide [a/tau]
  T drift = T(0.0);      // time integral of x minus that of the reference slide, bounces included [a tau]
  T held_work = T(0.0);  // hammer: energy from the holder to the bounces, the integral of rho P' [m a^2/tau^2]
};
using Chatter = ChatterOf<double>;

// The same in variables whose rates change slowly, so that the integrator can take long steps. With a cutoff v falls
// and n grows exponentially: x = ln v, and n = rest + v_c / ((1 - gamma) v). If v hardly falls in a step, n = rest.
// Without a cutoff v falls linearly: x = v, and n = rest - log(v) over a constant.
template <class T>
struct SmoothChatterOf {
  T x, rest, sigma, p, drift, held_work;
};
using SmoothChatter = SmoothChatterOf<double>;

template <class T>
SmoothChatterOf<T> operator+(const SmoothChatterOf<T>& a, const SmoothChatterOf<T>& b) {
  return {a.x + b.x, a.rest + b.rest, a.sigma + b.sigma, a.p + b.p, a.drift + b.drift, a.held_work + b.held_work};
}
template <class T>
SmoothChatterOf<T> operator*(const T& k, const SmoothChatterOf<T>& c) {
  return {k * c.x, k * c.rest, k * c.sigma, k * c.p, k * c.drift, k * c.held_work};
}

// One point of the integration.
struct ChatterPoint {
  double s;  // time since the start of the reference slide [tau]
  ChatterSurroundings surroundings;
  SmoothChatter smooth, rate;  // the variables and their time derivatives
  Chatter chatter;
  double n_per_inverse_v;  // the part of n that is proportional to 1/v and not in `smooth.rest`
};

// How long a bounce lasts there [tau].
inline double duration(const ChatterPoint& at) { return 2.0 * at.chatter.v * at.surroundings.inverse_P; }

// The constants of a model that the rates use.
struct ChatterFlow {
  bool geometric;        // without a cutoff: every bounce loses the same part of v
  bool is_held_along_x;  // the hammer
  double gamma;
  double loss;             // w/v: (1 - gamma) / v_c [tau/a]; 0 without a cutoff
  double n_per_inverse_v;  // with a cutoff 1 / loss; without one 1 / -log(gamma); 0 if v hardly falls
  double inverse_mean;     // (1 - gamma) / -log(gamma): mean v of a bounce over its first
};

class ChatterRates {
 public:
  // geometric: without regard to the cutoff, as if it were 0.
  ChatterRates(const Model& model, bool geometric);

  ChatterPoint begin(const SlideSegment<double>& reference, double s, const Chatter& start) const;
  // Over dt, by Lobatto's method of order 8 with three iterations. After a step that is too long the result may be NaN.
  ChatterPoint step(const SlideSegment<double>& reference, const ChatterPoint& from, double dt) const;
  // Over at most two bounces, forwards or backwards, by the mean of two rates: second order.
  ChatterPoint brief_step(const SlideSegment<double>& reference, const ChatterPoint& from, double dt) const;
  // Over so short a time that the rates are constant.
  Chatter after(const ChatterPoint& from, double dt) const;

  // The time in which v falls by the factor e, or without a cutoff to zero, by the losses alone [tau].
  double fall_time(const ChatterSurroundings& at, double v) const;
  double x_of(double v) const;                            // if the tip is on the reference slide
  double loss(double v) const { return flow_.loss * v; }  // w, with a cutoff
  const ChatterFlow& flow() const { return flow_; }
  const ChatterGeometry& geometry() const { return geometry_; }

 private:
  ChatterGeometry geometry_;
  ChatterFlow flow_;
};

// The reference slide, displaced by what the chatter has moved the tip.
SlideState<double> moved_reference(const Model& model, const SlideState<double>& reference, const Chatter& chatter);

}  // namespace afm
