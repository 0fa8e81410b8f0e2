// The steps of the impact search: the time for which the gap is certainly positive, and intervals that certainly hold
// one root. The lemmas are those of docs/algorithm.md.
#pragma once

#include <algorithm>
#include <cmath>

#include "afm/flight.h"
#include "core/release_noise.h"

namespace afm::detail {

// x within [low, high]; `low` if x is NaN.
template <class T>
T clamp(const T& x, const T& low, const T& high) {
  if (!(x > low)) return low;
  return x < high ? x : high;
}

// Lemma 1: with c = low, g + g1 t + g2 t^2/2 + c t^3/6 is a lower bound of the gap on [0, S] (or [-S, 0]). With c =
// high it is an upper bound, and its derivative is an upper bound of the gap rate.
template <class T>
struct ThirdDerivative {
  T low, high;
};

template <class T>
ThirdDerivative<T> third_derivative_over(const Flight<T>& f, const GapJet<T>& jet, const T& S) {
  using std::max;
  using std::min;
  const FlightBounds<T>& bounds = bounds_of(f);
  const T bound3 = bounds.third;
  const T change = fourth_derivative_bound(f.springs(), f.eta(), jet.state, bounds, S) * S;
  return {max(T(-bound3), T(jet.g3 - change * T(0.25))), min(bound3, T(jet.g3 + divide(change, 3.0)))};
}

// Lemma 2: first positive root of g + g1 t + q t^2/2, or `none` if there is none. Precondition: g > 0.
template <class T>
T first_root(const T& g, const T& g1, const T& q, const T& none) {
  using std::sqrt;
  const T discriminant = g1 * g1 - T(2.0) * q * g;
  if (discriminant < T(0.0)) return none;
  if (g1 < T(0.0)) return T(2.0) * g / (sqrt(discriminant) - g1);
  return q < T(0.0) ? T((g1 + sqrt(discriminant)) / (-q)) : none;
}

// Lemma 2: a step over which the gap is certainly positive. On [0, S] it is at least g - error + g1 t + (g2 + low S/3)
// t^2/2. Every trial step S is safe; a good one lies just beyond the root of this parabola. From a gap below twice its
// rounding the step is zero. So every step changes the gap by more than its rounding, and the search ends.
template <class T>
T safe_step(const Flight<T>& f, const GapJet<T>& jet, const T& error, const T& trial) {
  using std::min;
  const T g = jet.g - error;
  if (!(g > error)) return T(0.0);
  const T low = min(T(0.0), third_derivative_over(f, jet, trial).low);
  return min(trial, first_root(g, jet.g1, T(jet.g2 + divide(T(low * trial), 3.0)), trial));
}

// Lemma 2, backwards: the gap is certainly positive over all of the time `back` before the jet.
template <class T>
bool positive_behind(const Flight<T>& f, const GapJet<T>& jet, const T& error, const T& back) {
  using std::max;
  const T g = jet.g - error;
  if (!(g > T(0.0))) return false;
  const T high = max(T(0.0), third_derivative_over(f, jet, back).high);
  const T q = jet.g2 - divide(T(high * back), 3.0), end = g + back * (q * back / T(2.0) - jet.g1);
  // a parabola that opens downwards has its minimum at an end; otherwise the minimum may lie in between
  return end > T(0.0) && (!(q > T(0.0)) || jet.g1 * jet.g1 < T(2.0) * q * g || !(T(0.0) < jet.g1) || q * back < jet.g1);
}

// Lemma 3: an interval [low, high], relative to the time of the evaluation, in which the gap falls from positive to
// negative.
template <class T>
struct RootInterval {
  bool certain;
  T estimate, low, high;
};

// The fourth derivative of the gap.
template <class T>
T fourth_derivative(const Flight<T>& f, const GapJet<T>& jet) {
  const SpringConstants<T>& m = f.springs();
  const FlightState<T>& q = jet.state;
  const T k2 = two_pi<T>() * two_pi<T>(), wh2 = m.omega_h * m.omega_h, wv2 = m.omega_v * m.omega_v;
  const T u = f.eta() + q.U, x2 = -wh2 * q.X, x3 = -wh2 * q.U, v2 = k2 * u * u;
  const T bend = mul_add(T(-v2), v2, T(k2 * mul_add(T(T(3.0) * x2), x2, T(T(4.0) * u * x3))));
  return mul_add(jet.h, bend, mul_add(T(jet.h1 * x2), mul_add(T(6.0), v2, wh2), T(wv2 * wv2 * q.Y)));
}

// The root of the gap's series to the fourth order, by one Newton step from the root `t` of the parabola.
template <class T>
T quartic_root(const Flight<T>& f, const GapJet<T>& jet, const T& t) {
  const T g4 = fourth_derivative(f, jet);
  const T slope = mul_add(t, mul_add(t, mul_add(t, divide(g4, 6.0), T(jet.g3 / T(2.0))), jet.g2), jet.g1);
  return t - (t * t * t) * divide(mul_add(t, T(g4 / T(4.0)), jet.g3), 6.0) / slope;
}

template <class T>
RootInterval<T> no_root() {
  return {false, T(0.0), T(0.0), T(0.0)};
}

// The interval of a root over the root of the parabola; any number above 1 is safe. The table of constants in
// docs/algorithm.md ("The search") shows what it costs, as of every other constant here.
constexpr double kRootReach = 1.25;
constexpr double kRoundingReach = 4.0;  // the interval also holds the time that the rounding is worth, so many times

// Lemma 3, ahead of a gap that is positive or within rounding.
template <class T>
RootInterval<T> certify_root(const Flight<T>& f, const GapJet<T>& jet, const T& error) {
  using std::max;
  if (!(jet.g1 < T(0.0))) return no_root<T>();
  const T high = jet.g + error, t = high > T(0.0) ? first_root(high, jet.g1, jet.g2, T(-1.0)) : T(0.0);
  if (t < T(0.0)) return no_root<T>();
  const T d = T(kRootReach) * t + T(kRoundingReach) * error / -jet.g1, third = third_derivative_over(f, jet, d).high;
  const T slope = jet.g1 + max(T(0.0), T(jet.g2 * d + max(T(0.0), third) * d * d / T(2.0)));
  const T end = high + d * (jet.g1 + d * (jet.g2 / T(2.0) + divide(T(d * third), 6.0)));
  return {slope < T(0.0) && end < T(0.0), clamp(quartic_root(f, jet, t), T(0.0), d), T(0.0), d};
}

// Lemma 3, behind: the gap is certainly positive at a time `back` before the jet, and certainly negative at the jet.
template <class T>
RootInterval<T> certify_root_behind(const Flight<T>& f, const GapJet<T>& jet, const T& error, const T& back) {
  using std::max;
  using std::sqrt;
  const T discriminant = mul_add(T(T(-2.0) * jet.g2), jet.g, T(jet.g1 * jet.g1));
  if (!(jet.g1 < T(0.0)) || !(jet.g + error < T(0.0)) || discriminant < T(0.0)) return no_root<T>();
  const T third = max(T(0.0), third_derivative_over(f, jet, back).high);
  const T slope = jet.g1 + max(T(0.0), T(third * back * back / T(2.0) - jet.g2 * back));
  const T t = T(2.0) * jet.g / (sqrt(discriminant) - jet.g1);
  return {slope < T(0.0), clamp(quartic_root(f, jet, t), T(-back), T(0.0)), T(-back), T(0.0)};
}

// Lemma 5: on leaving the surface the gap is at least g1 s + g2 s^2/2 - bound3 s^3/6, which is positive up to its root.
// We use 0.999 of that, so that a gap is left for the next evaluation. If gap rate and acceleration are zero, as at the
// end of contact, the third derivative decides: g3 s^3/6 - bound4 s^4/24.
template <class T>
T time_to_leave(const Flight<T>& f) {
  using std::max;
  using std::sqrt;
  const T g1 = f.start().g1, b = f.start().g2 / T(2.0), a = divide(bounds_of(f).third, 6.0);
  const T root = sqrt(mul_add(T(T(4.0) * a), g1, T(b * b)));
  const T first = T(0.999) * (b > T(0.0) ? T((b + root) / (a * T(2.0))) : T(T(2.0) * g1 / (root - b)));
  if (g1 > T(0.0) || b < T(-kReleaseNoise)) return first;
  return max(b > T(0.0) ? first : T(0.0), T(T(3.0) * f.start().g3 / bounds_of(f).fourth));
}

// The angle of the point (x, y) in turns, y > 0, with an error below 3e-6.
inline double rough_turn(double x, double y) {
  const double ax = std::abs(x), t = y > ax ? ax / y : y / ax, z = t * t;
  // Hastings' polynomial of the arctangent, |error| < 1e-5 rad (Abramowitz and Stegun, 4.4.47)
  const double low = std::fma(z, -0.3302995 / kTwoPi, 0.9998660 / kTwoPi);
  const double high = std::fma(z, std::fma(z, 0.0208351 / kTwoPi, -0.0851330 / kTwoPi), 0.1801410 / kTwoPi);
  const double part = t * std::fma(z * z, high, low), turn = y > ax ? 0.25 - part : part;
  return x < 0.0 ? 0.5 - turn : turn;
}

// Lemma 4: the time that the tip needs from here over its top and down to the crest, less a margin [tau]. 0 if that is
// not worth a step. In double for every number type.
template <class T>
T time_to_crest(const Flight<T>& f, const FlightState<T>& q) {
  constexpr double kMargin = 1e-5;   // [tau] three times the error of rough_turn
  constexpr double kMinStep = 1e-3;  // [tau] a choice: a hundred margins
  const double crest = static_cast<double>(T(f.springs().H - f.springs().y0));
  const double Y = static_cast<double>(q.Y), V = static_cast<double>(T(q.W * f.springs().inverse_omega_v));
  // turn from now to the top plus from the top down to the crest: the angle of a product of two complex numbers
  const double Q = std::sqrt(std::max(0.0, std::fma(V, V, std::fma(Y, Y, -crest * crest))));
  const double sine = std::fma(Y, Q, V * crest);
  if (!(sine > 0.0)) return T(0.0);
  const double down = rough_turn(std::fma(-V, Q, Y * crest), sine) - kMargin;
  return T(down > kMinStep ? down : 0.0);
}

// Lemma 4 for a tip above the crest; otherwise 0.
template <class T>
T time_above_crest(const Flight<T>& f, const FlightState<T>& q) {
  return q.Y > f.springs().H - f.springs().y0 ? time_to_crest(f, q) : T(0.0);
}

// Lemma 4 from a launch, if the tip is certainly above the crest at `s`; otherwise 0. Precondition: it is certified up
// to `s`.
template <class T>
T time_above_crest_from_launch(const Flight<T>& f, const T& s) {
  const SpringConstants<T>& m = f.springs();
  const FlightState<T>& q = f.start().state;
  const T least = q.Y + s * (q.W - s * (m.omega_v * m.omega_v * bounds_of(f).Y / T(2.0)));
  return least > m.H - m.y0 ? time_to_crest(f, q) : T(0.0);
}

}  // namespace afm::detail
