// The last of an impact search: from a look near a certified root to the root itself, by series.
#pragma once

#include "impact_steps.h"

namespace afm {

// A jet near a root, with what the steps to there need besides.
template <class T>
struct NearJet {
  const GapJet<T>& jet;
  T g4, per_g1;

  NearJet(const Flight<T>& f, const GapJet<T>& near)
      : jet(near), g4(fourth_derivative(f, near)), per_g1(T(1.0) / near.g1) {}
};

// The step to the root near by, correct to the fourth order: the series of the inverse function.
template <class T>
T root_step(const NearJet<T>& near) {
  const GapJet<T>& jet = near.jet;
  const T& per = near.per_g1;
  // 1 + s2 + (2 s2^2 - s3) + (5 s2^3 - 5 s2 s3 + s4); of a bounce of 1e-100 a/tau no power of 1 / g1 is a number
  const T r = jet.g * per, a2 = (jet.g2 / T(2.0)) * per, s2 = a2 * r, s3 = (over(jet.g3, 6.0) * per) * r * r;
  const T s4 = (over(near.g4, 24.0) * per) * r * (r * r), w = mul_add(s2, s2, T(-s3));
  const T sum = mul_add(s2, s2, mul_add(a2, r, T(1.0))) + s4;
  return -r * mul_add(w, mul_add(T(5.0), s2, T(1.0)), sum);
}

// The same for a root so near that the second order is enough: `enough` where what it leaves out of the step is well
// below an ulp of the time, and what short_drift leaves out of the gap rate below an ulp of that.
template <class T>
struct ShortStep {
  Truth<T> enough;
  T step;
};

template <class T>
ShortStep<T> short_step(const Flight<T>& f, const NearJet<T>& near, const T& time) {
  using std::abs;
  const GapJet<T>& jet = near.jet;
  const T& per = near.per_g1;
  const T r = jet.g * per, s2 = (jet.g2 / T(2.0)) * per * r, s3 = (over(jet.g3, 6.0) * per) * r * r;
  const T size = abs(r), turn = f.fastest() * size, cube = turn * turn * turn, eps = epsilon<T>();
  const T left_out = T(5.0) * abs(s2) * mul_add(s2, s2, T(abs(s3)));
  return {cube * T(4.0) <= eps && cube * (f.fastest() * f.reach()) * T(8.0) <= eps * abs(jet.g1) &&
              left_out * size * T(64.0) <= eps * time,
          -r * (mul_add(s2, mul_add(T(2.0), s2, T(1.0)), T(1.0)) - s3)};
}

// c0 + c1 t + c2 t^2/2
template <class T>
T taylor(const T& t, const T& c0, const T& c1, const T& c2) {
  return mul_add(t, mul_add(t, T(c2 / T(2.0)), c1), c0);
}
// c0 + c1 t + c2 t^2/2 + c3 t^3/6 + c4 t^4/24
template <class T>
T taylor(const T& t, const T& c0, const T& c1, const T& c2, const T& c3) {
  return mul_add(t, mul_add(t, mul_add(t, over(c3, 6.0), T(c2 / T(2.0))), c1), c0);
}
template <class T>
T taylor(const T& t, const T& c0, const T& c1, const T& c2, const T& c3, const T& c4) {
  return mul_add(t, mul_add(t, mul_add(t, mul_add(t, over(c4, 24.0), over(c3, 6.0)), T(c2 / T(2.0))), c1), c0);
}

// The slope below a tip that goes on for t, to the fourth order; A, J, S: the second to the fourth derivatives of x.
template <class T>
T slope_after(const GapJet<T>& jet, const T& t, const T& u, const T& A, const T& J, const T& S) {
  const T k2 = two_pi<T>() * two_pi<T>(), h = jet.h, h1 = jet.h1, hA = h * A, u2 = u * u, v2 = k2 * u2, three(3.0);
  // the derivatives of h u: those of the slope, over -k^2
  const T second = mul_add(h1, u2, hA), third = mul_add(u, mul_add(T(three * h1), A, T(-h * v2)), T(h * J));
  const T bend = mul_add(h1, u2, T(T(6.0) * hA)), pull = mul_add(T(three * A), A, T(T(4.0) * u * J));
  const T fourth = mul_add(T(-v2), bend, mul_add(h1, pull, T(h * S)));
  return taylor(t, h1, T(-k2 * (h * u)), T(-k2 * second), T(-k2 * third), T(-k2 * fourth));
}

// The jet a tiny step further on: position, slope and gap rate to the fourth order.
template <class T>
GapJet<T> drift(const Flight<T>& f, const NearJet<T>& near, const T& t) {
  const GapJet<T>& jet = near.jet;
  const Mechanics<T>& m = f.mechanics();
  const FlightState<T>& q = jet.state;
  const T wh2 = m.omega_h * m.omega_h, wv2 = m.omega_v * m.omega_v, u = f.eta() + q.U;
  // the second to the fourth derivatives of x, and of y
  const T A = -wh2 * q.X, J = -wh2 * q.U, S = -wh2 * A, B = -wv2 * q.Y, K = -wv2 * q.W, R = -wv2 * B;
  const FlightState<T> moved{taylor(t, q.phase, u, A, J, S), taylor(t, q.X, q.U, A, J, S), taylor(t, q.U, A, J, S),
                             taylor(t, q.Y, q.W, B, K, R), taylor(t, q.W, B, K, R)};
  const T g = taylor(t, jet.g, jet.g1, jet.g2, jet.g3, near.g4);
  return {g,
          taylor(t, jet.g1, jet.g2, jet.g3, near.g4),
          mul_add(t, mul_add(T(t / T(2.0)), near.g4, jet.g3), jet.g2),
          mul_add(t, near.g4, jet.g3),
          moved,
          (moved.Y + m.y0) - g,
          slope_after(jet, t, u, A, J, S)};
}

// The same to the second order, after a short step.
template <class T>
GapJet<T> short_drift(const Flight<T>& f, const GapJet<T>& jet, const T& t) {
  const Mechanics<T>& m = f.mechanics();
  const FlightState<T>& q = jet.state;
  const T k2 = two_pi<T>() * two_pi<T>(), wh2 = m.omega_h * m.omega_h, wv2 = m.omega_v * m.omega_v;
  const T u = f.eta() + q.U, A = -wh2 * q.X, J = -wh2 * q.U, B = -wv2 * q.Y, K = -wv2 * q.W, h = jet.h, h1 = jet.h1;
  const FlightState<T> moved{taylor(t, q.phase, u, A), taylor(t, q.X, q.U, A), taylor(t, q.U, A, J),
                             taylor(t, q.Y, q.W, B), taylor(t, q.W, B, K)};
  const T g = taylor(t, jet.g, jet.g1, jet.g2);
  return {g,
          taylor(t, jet.g1, jet.g2, jet.g3),
          mul_add(t, jet.g3, jet.g2),
          jet.g3,
          moved,
          (moved.Y + m.y0) - g,
          taylor(t, h1, T(-k2 * (h * u)), T(-k2 * mul_add(T(h1 * u), u, T(h * A))))};
}

}  // namespace afm
