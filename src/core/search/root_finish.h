// The finish of an impact search: from an evaluation near a certified root to the root (Lemma 6 of docs/algorithm.md).
#pragma once

#include "impact_steps.h"

namespace afm::detail {

// The step to a root nearby, by the series of the inverse function to the fourth order:
// -r (1 + s2 + (2 s2^2 - s3) + (5 s2^3 - 5 s2 s3 + s4)), r = g/g1, sn = gn/(n! g1) r^(n-1).
template <class T>
T root_step(const Flight<T>& f, const GapJet<T>& jet) {
  const T inverse = T(1.0) / jet.g1, r = jet.g * inverse, a2 = (jet.g2 / T(2.0)) * inverse, s2 = a2 * r;
  const T s3 = (divide(jet.g3, 6.0) * inverse) * r * r,
          s4 = (divide(fourth_derivative(f, jet), 24.0) * inverse) * r * (r * r);
  const T w = mul_add(s2, s2, T(-s3)), sum = mul_add(s2, s2, mul_add(a2, r, T(1.0))) + s4;
  return -r * mul_add(w, mul_add(T(5.0), s2, T(1.0)), sum);
}

// The gap at s + step from its jet at s: faster than gap(s + step), with an error of a few ulp more.
template <class T>
GapJet<T> gap_near(const Flight<T>& f, const GapJet<T>& jet, const T& s, const T& step) {
  using std::abs;
  const T size = abs(step), end = s + step;
  if (is_small(bounds_of(f), end) || !is_small(bounds_of(f), size)) return f.gap(end);
  return advance_jet(f.springs(), f.eta(), jet, step);
}

// The jet at a time t later, to the first order in each member. Precondition: t^2 is below the rounding of the state.
template <class T>
GapJet<T> nudged(const Flight<T>& f, const GapJet<T>& jet, const T& t) {
  const SpringConstants<T>& m = f.springs();
  const FlightState<T>& q = jet.state;
  const T k2 = two_pi<T>() * two_pi<T>(), u = f.eta() + q.U;
  const T U = mul_add(t, T(-m.omega_h * m.omega_h * q.X), q.U), W = mul_add(t, T(-m.omega_v * m.omega_v * q.Y), q.W);
  const FlightState<T> state{mul_add(t, u, q.phase), mul_add(t, q.U, q.X), U, mul_add(t, q.W, q.Y), W};
  return {mul_add(t, jet.g1, jet.g),
          mul_add(t, jet.g2, jet.g1),
          mul_add(t, jet.g3, jet.g2),
          jet.g3,
          state,
          mul_add(t, T(jet.h1 * u), jet.h),
          mul_add(t, T(-k2 * jet.h * u), jet.h1)};
}

}  // namespace afm::detail
