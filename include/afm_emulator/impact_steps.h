// The steps of the impact search: how far the gap is certainly positive, and where it certainly has one root.
#pragma once

#include <algorithm>
#include <cmath>

#include "afm_emulator/flight.h"

namespace afm {

template <class T>
T clamp(const T& x, const T& low, const T& high) {
  return x < low ? low : (high < x ? high : x);
}

// The third derivative of the gap at the start, and a bound of the fourth for the whole flight.
template <class T>
struct HigherDerivatives {
  T g3, bound4;
};

template <class T>
HigherDerivatives<T> higher_derivatives(const Flight<T>& f) {
  using std::abs;
  const Mechanics<T>& m = f.mechanics();
  const FlightState<T>& q = f.start().state;
  const SurfaceJet<T> h = surface_jet(m.H, q.phase);
  const T k = two_pi<T>(), wh2 = m.omega_h * m.omega_h, wv2 = m.omega_v * m.omega_v;
  const T u = f.eta() + q.U, x2 = -wh2 * q.X, x3 = -wh2 * q.U;
  const T g3 = -wv2 * q.W - (h.h3 * u * u * u + T(3.0) * h.h2 * u * x2 + h.h1 * x3);
  const T v = abs(f.eta()) + m.omega_h * f.amplitude_X(), a = wh2 * f.amplitude_X();
  const T bound4 = wv2 * wv2 * f.amplitude_Y() + k * m.H *
                                                     (k * k * k * v * v * v * v + T(6.0) * k * k * v * v * a +
                                                      T(3.0) * k * a * a + T(4.0) * k * v * m.omega_h * a + wh2 * a);
  return {g3, bound4};
}

// Leaving the surface: g = g1 s + g2 s^2/2 - bound3 s^3/6 at least, positive up to its first root. A little less than
// that, so that a bounce whose root it nearly is still has a gap to be seen, and the root is near. Where gap rate and acceleration are nothing, as
// at the end of a slide, the third derivative decides: g3 s^3/6 - bound4 s^4/24.
template <class T>
T leave_surface(const Flight<T>& f) {
  using std::max;
  using std::sqrt;
  const T g1 = f.start().g1, b = f.start().g2 / T(2.0), a = f.third_derivative_bound() / T(6.0);
  const T root = sqrt(b * b + T(4.0) * a * g1);
  const T first = T(0.999) * (b > T(0.0) ? (b + root) / (a * T(2.0)) : T(2.0) * g1 / (root - b));
  if (g1 > T(0.0) || b < T(-kReleaseNoise)) return first;
  const HigherDerivatives<T> next = higher_derivatives(f);
  return max(b > T(0.0) ? first : T(0.0), T(3.0) * next.g3 / next.bound4);
}

// First positive root of g + g1 t + q t^2/2, or `none` where there is none. Precondition: g > 0.
template <class T>
T first_root(const T& g, const T& g1, const T& q, const T& none) {
  using std::sqrt;
  const T discriminant = g1 * g1 - T(2.0) * q * g;
  if (discriminant < T(0.0)) return none;
  if (g1 < T(0.0)) return T(2.0) * g / (sqrt(discriminant) - g1);
  return q < T(0.0) ? (g1 + sqrt(discriminant)) / (-q) : none;
}

// A step over which the gap is certainly positive: on [0, S] it is at least g - error + g1 t + (g2 - bound3 S/3) t^2/2.
// Any S is safe; a good one lies just beyond the root it gives.
template <class T>
T safe_step(const Flight<T>& f, const GapJet<T>& jet, const T& error, const T& guess) {
  const T g = jet.g - error;
  if (!(g > T(0.0))) return T(0.0);
  T step = T(0.0), S = guess;
  for (int i = 0; i < 2; ++i) {
    const T bound3 = f.third_derivative_bound(jet, S);
    const T root = first_root(g, jet.g1, jet.g2 - bound3 * S / T(3.0), S);
    if (!(root < S)) return S;
    step = root;
    S = T(1.25) * root;
  }
  return step;
}

// An interval [0, length] from the present time on which the gap falls all the way and ends below zero.
template <class T>
struct RootInterval {
  bool certain;
  T estimate, length;
};

template <class T>
RootInterval<T> certify_root(const Flight<T>& f, const GapJet<T>& jet, const T& error) {
  using std::max;
  const RootInterval<T> none{false, T(0.0), T(0.0)};
  if (!(jet.g1 < T(0.0))) return none;
  const T high = jet.g + error;
  const T t = high > T(0.0) ? first_root(high, jet.g1, jet.g2, T(-1.0)) : T(0.0);
  if (t < T(0.0)) return none;
  const T d = T(1.25) * t + T(4.0) * error / -jet.g1;
  const T bound3 = f.third_derivative_bound(jet, d);
  const T slope = jet.g1 + max(T(0.0), jet.g2 * d + bound3 * d * d / T(2.0));
  const T end = high + d * (jet.g1 + d * (jet.g2 / T(2.0) + d * bound3 / T(6.0)));
  return {slope < T(0.0) && end < T(0.0), t, d};
}

// angle / 2 pi of the point (x, y), y > 0, within 3e-6: it only isolates.
inline double rough_turn(double x, double y) {
  const double ax = std::abs(x);
  const bool steep = y > ax;
  const double t = steep ? ax / y : y / ax;
  const double z = t * t;
  // Hastings' polynomial of the arctangent, |error| < 1e-5 rad
  const double atan = t * (0.9998660 + z * (-0.3302995 + z * (0.1801410 + z * (-0.0851330 + z * 0.0208351))));
  double turn = atan / kTwoPi;
  if (steep) turn = 0.25 - turn;
  return x < 0.0 ? 0.5 - turn : turn;
}

// Above the crest nothing can happen: how long the tip stays there, less a margin; 0 when that is not worth a step.
template <class T>
T time_above_crest(const Flight<T>& f, const FlightState<T>& q) {
  constexpr double kMargin = 1e-5;  // [tau]: three times the error of rough_turn
  constexpr double kWorthwhile = 1e-3;
  const double crest = static_cast<double>(f.mechanics().H - f.mechanics().y0);
  const double Y = static_cast<double>(q.Y), V = static_cast<double>(q.W * f.mechanics().per_omega_v);
  if (!(Y > crest)) return T(0.0);
  // turn from now to the top plus from the top down to the crest: the angle of a product of two complex numbers
  const double Q = std::sqrt(std::max(0.0, Y * Y + V * V - crest * crest));
  const double down = rough_turn(Y * crest - V * Q, Y * Q + V * crest) - kMargin;
  return T(down > kWorthwhile ? down : 0.0);
}

// The jet a tiny step further on.
template <class T>
GapJet<T> drift(const Flight<T>& f, const GapJet<T>& jet, const T& t) {
  const Mechanics<T>& m = f.mechanics();
  const FlightState<T>& q = jet.state;
  const T half = t / T(2.0);
  const T A = -m.omega_h * m.omega_h * q.X, B = -m.omega_v * m.omega_v * q.Y;
  FlightState<T> moved{q.phase + t * (f.eta() + q.U + half * A), q.X + t * (q.U + half * A), q.U + t * A,
                       q.Y + t * (q.W + half * B), q.W + t * B};
  return {jet.g + t * (jet.g1 + half * jet.g2), jet.g1 + t * jet.g2, jet.g2, moved};
}

}  // namespace afm
