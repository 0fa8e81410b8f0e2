// Exact flight (Eq. 9-10 of the paper) and the gap along it. Times s count from the start of the flight [tau]. The
// extensions X = x - xc and Y = y - y0 rotate with U = u - eta and W = w, each pair by the angle of its spring.
// Guarantees: the rounding of the gap is bounded by gap_error() (Lemma 7 of docs/algorithm.md), and no energy drifts.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "afm/detail/flight_bounds.h"
#include "afm/detail/select.h"
#include "afm/detail/spring_constants.h"
#include "afm/detail/turns.h"
#include "state.h"
#include "surface.h"

namespace afm {

// The gap y - h(x) and its time derivatives, with the state they belong to and the surface below it.
template <class T>
struct GapJet {
  T g, g1, g2, g3;
  FlightState<T> state;
  T h, h1;
};

template <class T>
class Flight {
 public:
  Flight(const SpringConstants<T>& springs, const T& eta, const TipState& start);
  // From a known jet and bounds. Precondition: launch() is not used.
  Flight(const SpringConstants<T>& springs, const T& eta, const GapJet<T>& start, const FlightBounds<T>& bounds)
      : m_(springs), eta_(eta), launch_{0.0, 0.0, 0.0, 0.0, 0.0}, start_(start), bounds_(bounds) {}

  // Error: a few ulp of the larger terms; for small turns, a few ulp of the change since the start.
  GapJet<T> gap(const T& s) const;
  FlightState<T> at(const T& s) const;

  TipState tip_state(const T& s) const;

  // Bound of the rounding error of gap(s).g [a] (Lemma 7).
  T gap_error(const T& s) const;

  const TipState& launch() const { return launch_; }  // the state it began with, as given
  const GapJet<T>& start() const { return start_; }
  const T& eta() const { return eta_; }
  const SpringConstants<T>& springs() const { return m_; }

  // The gap at s + step from its jet at s: faster than gap(s + step), with an error of a few ulp more.
  GapJet<T> gap_near(const GapJet<T>& jet, const T& s, const T& step) const;

  // True: within the time s every angle turns by at most kSmallTurn.
  auto is_small(const T& s) const { return s * bounds_.fastest <= T(kSmallTurn); }

  GapJet<T> gap_by_small_turns(const T& s) const { return advance_jet(start_, s); }

  const FlightBounds<T>& bounds() const { return bounds_; }
  const T& amplitude_X() const { return bounds_.X; }
  const T& amplitude_Y() const { return bounds_.Y; }
  const T& third_derivative_bound() const { return bounds_.third; }
  const T& fourth_derivative_bound() const { return bounds_.fourth; }
  T fourth_derivative_bound(const FlightState<T>& now, const T& S) const {  // within S of the state `now`
    return afm::fourth_derivative_bound(m_, eta_, now, bounds_, S);
  }
  T fastest() const { return two_pi<T>() * bounds_.fastest; }  // [rad/tau]

 private:
  // The jet at a time t after `jet`. Terms that cancel are removed on paper, so the change of the gap is exact to a few
  // ulp of itself (Lemma 7). Precondition: is_small(t).
  GapJet<T> advance_jet(const GapJet<T>& jet, const T& t) const;
  GapJet<T> jet_at(const FlightState<T>& state) const;
  T second_derivative(const T& X, const T& u, const T& Y, const T& h, const T& h1) const;
  // The same from the gap instead of Y: Y = h - y0 + g. The height h is known last, and only one product waits for it.
  T second_derivative_above(const SurfaceJet<T>& surface, const T& g, const T& X, const T& u) const;
  T third_derivative(const FlightState<T>& q, const T& u, const T& h, const T& h1) const;

  SpringConstants<T> m_;
  T eta_;
  TipState launch_;
  GapJet<T> start_;
  FlightBounds<T> bounds_;
};

template <class T>
Flight<T>::Flight(const SpringConstants<T>& springs, const T& eta, const TipState& start)
    : m_(springs), eta_(eta), launch_(start) {
  const SurfaceJet<T> surface = surface_jet(springs.H, T(start.phase));
  const T W = mul_add(surface.h1, T(start.u), T(start.g1));
  const T Y = (surface.h - springs.y0) + T(start.g);
  const T X = T(start.X), u = T(start.u);
  const T g2 = second_derivative_above(surface, T(start.g), X, u);
  const FlightState<T> state{T(start.phase), X, u - eta, Y, W};
  start_ = {T(start.g), T(start.g1), g2,        third_derivative(state, u, surface.h, surface.h1),
            state,      surface.h,   surface.h1};
  bound_flight(springs, eta, start_.state, bounds_);
}

template <class T>
FlightState<T> Flight<T>::at(const T& s) const {
  const SpringConstants<T>& m = m_;
  const FlightState<T>& o = start_.state;
  const SinCos<T> h = sin_cos_turn_product(m.ratio, s);
  const SinCos<T> v = sin_cos_turns(s);
  const T X = mul_add(o.X, h.cos, T(m.divide_by_omega(o.U, m.omega_h, m.inverse_omega_h) * h.sin));
  const T U = mul_add(o.U, h.cos, T(-(m.omega_h * o.X) * h.sin));
  const T Y = mul_add(o.Y, v.cos, T(m.divide_by_omega(o.W, m.omega_v, m.inverse_omega_v) * v.sin));
  const T W = mul_add(o.W, v.cos, T(-(m.omega_v * o.Y) * v.sin));
  return {o.phase + (turn_product(eta_, s) + (X - o.X)), X, U, Y, W};
}

// With h'' = -k^2 h, h''' = -k^2 h', x'' = -omega_h^2 X and y'' = -omega_v^2 Y.
template <class T>
T Flight<T>::second_derivative(const T& X, const T& u, const T& Y, const T& h, const T& h1) const {
  const T k2 = two_pi<T>() * two_pi<T>(), wh2 = m_.omega_h * m_.omega_h, wv2 = m_.omega_v * m_.omega_v;
  return mul_add(h, T(k2 * u * u), mul_add(h1, T(wh2 * X), T(-wv2 * Y)));
}
template <class T>
T Flight<T>::second_derivative_above(const SurfaceJet<T>& surface, const T& g, const T& X, const T& u) const {
  const T k2 = two_pi<T>() * two_pi<T>(), wh2 = m_.omega_h * m_.omega_h, wv2 = m_.omega_v * m_.omega_v;
  const T rest = mul_add(surface.h1, T(wh2 * X), T(wv2 * (m_.y0 - g)));
  return mul_add(surface.h, mul_add(T(k2 * u), u, T(-wv2)), rest);
}
template <class T>
T Flight<T>::third_derivative(const FlightState<T>& q, const T& u, const T& h, const T& h1) const {
  const T k2 = two_pi<T>() * two_pi<T>(), wh2 = m_.omega_h * m_.omega_h, wv2 = m_.omega_v * m_.omega_v;
  const T straight = mul_add(T(k2 * u * u), u, T(wh2 * q.U)), bend = T(-3.0) * k2 * u * (wh2 * q.X);
  return mul_add(h1, straight, mul_add(h, bend, T(-wv2 * q.W)));
}

template <class T>
GapJet<T> Flight<T>::jet_at(const FlightState<T>& q) const {
  const SurfaceJet<T> surface = surface_jet(m_.H, q.phase);
  const T u = eta_ + q.U;
  return {(q.Y + m_.y0) - surface.h,
          mul_add(T(-surface.h1), u, q.W),
          second_derivative(q.X, u, q.Y, surface.h, surface.h1),
          third_derivative(q, u, surface.h, surface.h1),
          q,
          surface.h,
          surface.h1};
}

template <class T>
GapJet<T> Flight<T>::gap(const T& s) const {
  return is_small(s) ? advance_jet(start_, s) : jet_at(at(s));
}

template <class T>
GapJet<T> Flight<T>::gap_near(const GapJet<T>& jet, const T& s, const T& step) const {
  using std::abs;
  const T size = abs(step);
  if (is_small(s + step)) return gap(s + step);
  return is_small(size) ? advance_jet(jet, step) : gap(s + step);
}

// The terms linear in t combine to g1 t. The rest is of the second order, and each of its terms is exact to a few ulp.
template <class T>
GapJet<T> Flight<T>::advance_jet(const GapJet<T>& jet, const T& t) const {
  const SpringConstants<T>& m = m_;
  const FlightState<T>& o = jet.state;
  const T k = two_pi<T>(), per = m.inverse_omega_v, u0 = eta_ + o.U;
  const SmallTurn<T> h = small_turn(T(m.ratio * t)), v = small_turn(t);

  // changes: of x without its linear part, of u, of x
  const T dx2 = mul_add(T(o.U * m.inverse_omega_h), h.sin_minus_angle, T(-o.X * h.versine));
  const T du = mul_add(T(-o.U), h.versine, T(-(m.omega_h * o.X) * h.sin));
  const T dx = mul_add(u0, t, dx2), u = u0 + du;
  const SmallTurn<T> d = small_turn(dx);
  // changes: of Y without its linear part, and of -W
  const T dY2 = mul_add(T(o.W * per), v.sin_minus_angle, T(-o.Y * v.versine));
  const T brake = mul_add(o.W, v.versine, T((m.omega_v * o.Y) * v.sin));

  const T slip = mul_add(d.sin_minus_angle, per, dx2), rise = mul_add(T(-jet.h1), slip, T(jet.h * d.versine));
  const T g = mul_add(jet.g1, t, jet.g) + (dY2 + rise);
  const T turned = mul_add(T(-u), d.versine, du);
  const T g1 = jet.g1 - mul_add(T(-k * jet.h * u), d.sin, mul_add(jet.h1, turned, brake));

  const T h_now = jet.h + mul_add(T(jet.h1 * per), d.sin, T(-jet.h * d.versine));
  const T h1_now = jet.h1 - mul_add(jet.h1, d.versine, T(k * jet.h * d.sin));
  const FlightState<T> q{o.phase + dx, o.X + mul_add(o.U, t, dx2), o.U + du, o.Y + mul_add(o.W, t, dY2), o.W - brake};
  return {g,     g1,    second_derivative(q.X, u, q.Y, h_now, h1_now), third_derivative(q, u, h_now, h1_now), q,
          h_now, h1_now};
}

template <class T>
TipState Flight<T>::tip_state(const T& s) const {
  const GapJet<T> jet = gap(s);
  const T u = eta_ + jet.state.U;
  return {wrap_phase(static_cast<double>(jet.state.phase)), static_cast<double>(jet.state.X), static_cast<double>(u),
          static_cast<double>(jet.g), static_cast<double>(jet.g1)};
}

template <class T>
T Flight<T>::gap_error(const T& s) const {
  using std::abs;
  using std::max;
  constexpr double kOfChange = 8.0, kOfHeight = 4.0, kOfSurface = 16.0, kOfExtension = 32.0;  // [ulp] Lemma 7
  if (is_small(s)) return epsilon<T>() * (start_.g + T(kOfChange) * s * (abs(start_.g1) + bounds_.second * s));
  return epsilon<T>() * (T(kOfHeight) * bounds_.Y + max(T(kOfSurface), T(T(kOfExtension) * bounds_.X)) * m_.H);
}

}  // namespace afm
