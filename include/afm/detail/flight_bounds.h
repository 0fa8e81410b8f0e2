// Bounds of a whole flight from its start (Lemma 1 of docs/algorithm.md).
#pragma once

#include <algorithm>
#include <cmath>

#include "afm/spring_constants.h"
#include "afm/state.h"
#include "turns.h"

namespace afm {

template <class T>
class Flight;

namespace detail {

// Guarantee: they hold for the whole flight, and exceed the exact bounds by little.
template <class T>
struct FlightBounds {
  T X, Y;                   // of |X| and |Y| [a]
  T second, third, fourth;  // of the gap's time derivatives
  T fastest;                // of the turns of springs and surface phase [1/tau]
};

// Those of a flight.
template <class T>
const FlightBounds<T>& bounds_of(const Flight<T>& flight) {
  return flight.bounds_;
}

// True: within the time s every angle turns by at most kSmallTurn.
template <class T>
bool is_small(const FlightBounds<T>& b, const T& s) {
  return s * b.fastest <= T(kSmallTurn);
}

// An upper bound of |(x, y)|, too large by at most a twelfth: the chord of the octagon, sqrt(2) - 1.
template <class T>
T length_bound(const T& x, const T& y) {
  using std::abs;
  using std::max;
  using std::min;
  const T a = abs(x), b = abs(y);
  return max(a, b) + T(0.41422) * min(a, b);
}

// g''' = y''' - h''' u^3 - 3 h'' u x'' - h' x''', and its derivative. U and x'' are sine and cosine of one angle. So u
// x'' is at most (|eta| + U/2) a, and u^2 x'' at most (eta^2 + |eta| U + 0.385 U^2) a, with the largest U and a =
// |x''|. 0.385 = 2/sqrt(27) is the maximum of sin^2 cos.
template <class T>
void bound_flight(const SpringConstants<T>& m, const T& eta, const FlightState<T>& o, FlightBounds<T>& b) {
  using std::abs;
  using std::max;
  const T k = two_pi<T>(), drag = abs(eta), wv2 = m.omega_v * m.omega_v;
  b.X = length_bound(o.X, T(o.U * m.inverse_omega_h));
  b.Y = length_bound(o.Y, T(o.W * m.inverse_omega_v));
  const T U = m.omega_h * b.X, u = drag + U, a = m.omega_h * U, jerk = m.omega_h * a, v = k * u, slope = k * m.H;
  const T ua = (drag + U / T(2.0)) * a, u2a = (drag * (drag + U) + T(0.385) * U * U) * a;
  b.second = wv2 * b.Y + slope * (v * u + a);
  b.third = m.omega_v * wv2 * b.Y + slope * (v * v * u + T(3.0) * k * ua + jerk);
  b.fourth = wv2 * wv2 * b.Y +
             slope * (v * v * v * u + T(6.0) * k * k * u2a + T(3.0) * k * a * a + T(4.0) * v * jerk + m.omega_h * jerk);
  b.fastest = max(max(T(1.0), m.ratio), u);
}

// The fourth derivative within the time S of a state: u changes by at most |x''| S, and |X| by at most
// omega_h Xm S (Lemma 1).
template <class T>
T fourth_derivative_bound(const SpringConstants<T>& m, const T& eta, const FlightState<T>& now,
                          const FlightBounds<T>& b, const T& S) {
  using std::abs;
  using std::min;
  const T k = two_pi<T>(), wh2 = m.omega_h * m.omega_h, wv2 = m.omega_v * m.omega_v;
  const T a = wh2 * min(b.X, T(abs(now.X) + S * (m.omega_h * b.X))), change = a * S;
  const T u = abs(eta + now.U) + change, jerk = wh2 * (abs(now.U) + change), v = k * u;
  const T about = v * v * (v * u + T(6.0) * a) + a * (T(3.0) * k * a + wh2) + T(4.0) * v * jerk;
  return min(b.fourth, T(wv2 * wv2 * b.Y + k * m.H * about));
}

}  // namespace detail
}  // namespace afm
