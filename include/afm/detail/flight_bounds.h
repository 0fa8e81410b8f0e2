// What a flight cannot exceed, from its start alone.
#pragma once

#include <algorithm>
#include <cmath>

#include "mechanics.h"

namespace afm {

// The comoving state at one time, with the surface phase.
template <class T>
struct FlightState {
  T phase, X, U, Y, W;
};

// Bounds that hold for a whole flight, a little more than needed: of |X| and |Y|, and of the gap's derivatives.
template <class T>
struct FlightBounds {
  T X, Y, second, third, fourth;
  T drive;    // of |p'|, where g''' = p' - omega_v^2 g' and p depends on x alone
  T fastest;  // of the turns of springs and surface phase [1/tau]
};

// |(x, y)| from above, by at most a twelfth.
template <class T>
T length_bound(const T& x, const T& y) {
  using std::abs;
  using std::max;
  using std::min;
  const T a = abs(x), b = abs(y);
  return max(a, b) + T(0.41422) * min(a, b);
}

// Those of places, turns and the second derivative, from the state at the start, in place: a copy would have to wait
// until it is written.
template <class T>
void bound_places(const Mechanics<T>& m, const T& eta, const FlightState<T>& o, FlightBounds<T>& b) {
  using std::abs;
  using std::max;
  const T k = two_pi<T>();
  b.X = length_bound(o.X, T(o.U * m.per_omega_h));
  b.Y = length_bound(o.Y, T(o.W * m.per_omega_v));
  const T u_max = abs(eta) + m.omega_h * b.X, a_max = m.omega_h * m.omega_h * b.X;
  b.second = m.omega_v * m.omega_v * b.Y + k * m.H * (k * u_max * u_max + a_max);
  b.fastest = max(max(T(1.0), m.ratio), u_max);
}

// And from those of places those of the higher derivatives.
template <class T>
void bound_derivatives(const Mechanics<T>& m, const T& eta, FlightBounds<T>& b) {
  using std::abs;
  using std::max;
  const T k = two_pi<T>(), drag = abs(eta);
  const T u_max = drag + m.omega_h * b.X;
  const T u_low = max(T(0.0), drag - m.omega_h * b.X);
  const T a_max = m.omega_h * m.omega_h * b.X;
  const T slope = k * m.H, v = k * u_max, wv2 = m.omega_v * m.omega_v;
  // g''' = y''' - h''' u^3 - 3 h'' u x'' - h' x''', and once more. U and x'' are a sine and a cosine of one angle: of
  // u x'' no more than (|eta| + U_max/2) a is reached at once, of u^2 x'' (eta^2 + |eta| U_max + 0.385 U_max^2) a
  const T U = m.omega_h * b.X, k_a = k * a_max, wh_a = m.omega_h * a_max;
  const T ua = (drag + U / T(2.0)) * a_max, u2a = (drag * (drag + U) + T(0.385) * U * U) * a_max;
  b.third = m.omega_v * wv2 * b.Y + slope * (v * v * u_max + T(3.0) * k * ua + wh_a);
  b.fourth = wv2 * wv2 * b.Y + slope * (v * v * v * u_max + T(6.0) * k * k * u2a + T(3.0) * k_a * a_max +
                                        T(4.0) * v * wh_a + m.omega_h * wh_a);
  const T u_change = max(abs(u_max * u_max - T(1.0)), abs(u_low * u_low - T(1.0)));
  b.drive = slope * (k * v * u_change + T(3.0) * k * ua + wh_a);
}

// What a tip is within S of a state, before or after: no faster along x, no more accelerated, with no more jerk.
template <class T>
struct Reach {
  T speed, acceleration, jerk;
};

template <class T>
Reach<T> reach_within(const Mechanics<T>& m, const T& eta, const FlightState<T>& o, const FlightBounds<T>& b,
                      const T& S) {
  using std::abs;
  using std::min;
  const T wh2 = m.omega_h * m.omega_h;
  const T a = wh2 * min(b.X, T(abs(o.X) + S * (m.omega_h * b.X))), change = a * S;
  return {abs(eta + o.U) + change, a, wh2 * (abs(o.U) + change)};
}

// The fourth over the next S, or the last, only: after a long S it may be more than that of the whole flight.
template <class T>
T fourth_derivative_bound(const Mechanics<T>& m, const T& eta, const FlightState<T>& o, const FlightBounds<T>& b,
                          const T& S) {
  const T k = two_pi<T>(), wh2 = m.omega_h * m.omega_h, wv2 = m.omega_v * m.omega_v;
  const Reach<T> r = reach_within(m, eta, o, b, S);
  const T u = r.speed, a = r.acceleration, v = k * u;
  const T steady = v * v * (v * u + T(6.0) * a), stretched = a * (T(3.0) * k * a + wh2) + T(4.0) * v * r.jerk;
  return wv2 * wv2 * b.Y + k * m.H * (steady + stretched);
}

// The same where the slope is h1 now: a tip that creeps about a crest or a floor sees next to none.
template <class T>
T fourth_derivative_bound(const Mechanics<T>& m, const T& eta, const FlightState<T>& o, const T& h1,
                          const FlightBounds<T>& b, const T& S) {
  using std::abs;
  using std::min;
  const T k = two_pi<T>(), wh2 = m.omega_h * m.omega_h, wv2 = m.omega_v * m.omega_v, bend = k * k * m.H;
  const Reach<T> r = reach_within(m, eta, o, b, S);
  const T u = r.speed, a = r.acceleration, v = k * u, slope = min(T(k * m.H), T(abs(h1) + bend * u * S));
  const T bent = v * v * u * u + T(3.0) * a * a + T(4.0) * u * r.jerk, sloping = a * (T(6.0) * v * v + wh2);
  return wv2 * wv2 * b.Y + (bend * bent + slope * sloping);
}

}  // namespace afm
