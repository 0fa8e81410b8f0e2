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

// Bounds of the third derivative over the next S, or the last, sharp enough for g >= g + g1 t + g2 t^2/2 + low t^3/6 on all of [0, S], and
// likewise from above for gap and gap rate: from what it is now and the fourth derivative, or from its own bound.
template <class T>
struct ThirdDerivative {
  T low, high;
};

template <class T>
ThirdDerivative<T> third_derivative_over(const Flight<T>& f, const GapJet<T>& jet, const T& S) {
  using std::max;
  using std::min;
  const T bound3 = f.third_derivative_bound(jet, S), change = f.fourth_derivative_bound() * S;
  return {max(T(-bound3), T(jet.g3 - change * T(0.25))), min(bound3, T(jet.g3 + change / T(3.0)))};
}

// The fourth derivative of the gap.
template <class T>
T fourth_derivative(const Flight<T>& f, const GapJet<T>& jet) {
  const Mechanics<T>& m = f.mechanics();
  const FlightState<T>& q = jet.state;
  const T k2 = two_pi<T>() * two_pi<T>(), wh2 = m.omega_h * m.omega_h, wv2 = m.omega_v * m.omega_v;
  const T u = f.eta() + q.U, x2 = -wh2 * q.X, x3 = -wh2 * q.U, v2 = k2 * u * u;
  return wv2 * wv2 * q.Y + jet.h * (k2 * (T(3.0) * x2 * x2 + T(4.0) * u * x3) - v2 * v2) +
         jet.h1 * (T(6.0) * v2 + wh2) * x2;
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
  return max(b > T(0.0) ? first : T(0.0), T(3.0) * f.start().g3 / f.fourth_derivative_bound());
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

// A step over which the gap is certainly positive: on [0, S] it is at least g - error + g1 t + (g2 + low S/3) t^2/2 where low, its
// third derivative's bound, is negative. Any S is safe; a good one lies just beyond the root it gives.
template <class T>
T safe_step(const Flight<T>& f, const GapJet<T>& jet, const T& error, const T& guess) {
  using std::min;
  const T g = jet.g - error;
  if (!(g > T(0.0))) return T(0.0);
  T step = T(0.0), S = guess;
  for (int i = 0; i < 2; ++i) {
    const T low = min(T(0.0), third_derivative_over(f, jet, S).low);
    const T root = first_root(g, jet.g1, jet.g2 + low * S / T(3.0), S);
    if (!(root < S)) return S;
    step = root;
    S = T(1.25) * root;
  }
  return step;
}

// The gap is certainly positive over all of the time `back` before the jet.
template <class T>
bool positive_behind(const Flight<T>& f, const GapJet<T>& jet, const T& error, const T& back) {
  using std::max;
  const T g = jet.g - error;
  if (!(g > T(0.0))) return false;
  const T high = max(T(0.0), third_derivative_over(f, jet, back).high);
  const T q = jet.g2 - high * back / T(3.0), end = g + back * (q * back / T(2.0) - jet.g1);
  // a parabola that opens downwards has its least value at an end; another may dip in between
  return end > T(0.0) && (!(q > T(0.0)) || jet.g1 * jet.g1 < T(2.0) * q * g || !(T(0.0) < jet.g1) || q * back < jet.g1);
}

// An interval [low, high] about the present time on which the gap falls all the way, from above zero to below.
template <class T>
struct RootInterval {
  bool certain;
  T estimate, low, high;
};

// The cubic's root near that of the parabola, `t`.
template <class T>
T cubic_root(const GapJet<T>& jet, const T& t) {
  return t - jet.g3 * t * t * t / (T(6.0) * (jet.g1 + t * (jet.g2 + t * jet.g3 / T(2.0))));
}

template <class T>
RootInterval<T> certify_root(const Flight<T>& f, const GapJet<T>& jet, const T& error) {
  using std::max;
  const RootInterval<T> none{false, T(0.0), T(0.0), T(0.0)};
  if (!(jet.g1 < T(0.0))) return none;
  const T high = jet.g + error;
  const T t = high > T(0.0) ? first_root(high, jet.g1, jet.g2, T(-1.0)) : T(0.0);
  if (t < T(0.0)) return none;
  const T d = T(1.25) * t + T(4.0) * error / -jet.g1;
  const T third = third_derivative_over(f, jet, d).high;
  const T slope = jet.g1 + max(T(0.0), jet.g2 * d + max(T(0.0), third) * d * d / T(2.0));
  const T end = high + d * (jet.g1 + d * (jet.g2 / T(2.0) + d * third / T(6.0)));
  return {slope < T(0.0) && end < T(0.0), clamp(cubic_root(jet, t), T(0.0), d), T(0.0), d};
}

// The same behind, where the gap is certainly positive at a time `back` before, and certainly negative now.
template <class T>
RootInterval<T> certify_root_behind(const Flight<T>& f, const GapJet<T>& jet, const T& error, const T& back) {
  using std::max;
  using std::sqrt;
  const RootInterval<T> none{false, T(0.0), T(0.0), T(0.0)};
  const T discriminant = jet.g1 * jet.g1 - T(2.0) * jet.g2 * jet.g;
  if (!(jet.g1 < T(0.0)) || !(jet.g + error < T(0.0)) || discriminant < T(0.0)) return none;
  const T third = max(T(0.0), third_derivative_over(f, jet, back).high);
  const T slope = jet.g1 + max(T(0.0), third * back * back / T(2.0) - jet.g2 * back);
  const T t = T(2.0) * jet.g / (sqrt(discriminant) - jet.g1);
  return {slope < T(0.0), clamp(cubic_root(jet, t), T(-back), T(0.0)), T(-back), T(0.0)};
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

// How long the tip needs from here over its top and down to the crest, less a margin; 0 where that is not worth a step.
template <class T>
T time_to_crest(const Flight<T>& f, const FlightState<T>& q) {
  constexpr double kMargin = 1e-5;  // [tau]: three times the error of rough_turn
  constexpr double kWorthwhile = 1e-3;
  const double crest = static_cast<double>(f.mechanics().H - f.mechanics().y0);
  const double Y = static_cast<double>(q.Y), V = static_cast<double>(q.W * f.mechanics().per_omega_v);
  // turn from now to the top plus from the top down to the crest: the angle of a product of two complex numbers
  const double Q = std::sqrt(std::max(0.0, Y * Y + V * V - crest * crest));
  const double sine = Y * Q + V * crest;
  if (!(sine > 0.0)) return T(0.0);
  const double down = rough_turn(Y * crest - V * Q, sine) - kMargin;
  return T(down > kWorthwhile ? down : 0.0);
}

// Above the crest nothing can happen: how long the tip stays there.
template <class T>
T time_above_crest(const Flight<T>& f, const FlightState<T>& q) {
  return q.Y > f.mechanics().H - f.mechanics().y0 ? time_to_crest(f, q) : T(0.0);
}

// The same from the surface, where the tip certainly is above the crest at a time `s` up to which it certainly has left the surface.
template <class T>
T time_aloft(const Flight<T>& f, const T& s) {
  const Mechanics<T>& m = f.mechanics();
  const FlightState<T>& q = f.start().state;
  const T least = q.Y + s * (q.W - s * (m.omega_v * m.omega_v * f.amplitude_Y() / T(2.0)));
  return least > m.H - m.y0 ? time_to_crest(f, q) : T(0.0);
}

// The step to the root near by, correct to the third order: the series of the inverse function.
template <class T>
T root_step(const GapJet<T>& jet) {
  const T per = T(1.0) / jet.g1;
  const T r = jet.g * per, a2 = jet.g2 * per / T(2.0), a3 = jet.g3 * per / T(6.0);
  return -r * (T(1.0) + r * (a2 + r * (T(2.0) * a2 * a2 - a3)));
}

// The jet a tiny step further on, to the third order.
template <class T>
GapJet<T> drift(const Flight<T>& f, const GapJet<T>& jet, const T& t) {
  const Mechanics<T>& m = f.mechanics();
  const FlightState<T>& q = jet.state;
  const T half = t / T(2.0), third = t / T(3.0), wh2 = m.omega_h * m.omega_h, wv2 = m.omega_v * m.omega_v;
  const T A = -wh2 * q.X, J = -wh2 * q.U, B = -wv2 * q.Y, K = -wv2 * q.W;
  const T dU = t * (A + half * J), dX2 = half * (A + third * J);
  const FlightState<T> moved{q.phase + t * (f.eta() + q.U + dX2), q.X + t * (q.U + dX2), q.U + dU,
                             q.Y + t * (q.W + half * (B + third * K)), q.W + t * (B + half * K)};
  return {jet.g + t * (jet.g1 + half * (jet.g2 + third * jet.g3)), jet.g1 + t * (jet.g2 + half * jet.g3),
          jet.g2 + t * jet.g3, jet.g3, moved, jet.h, jet.h1};
}

}  // namespace afm
