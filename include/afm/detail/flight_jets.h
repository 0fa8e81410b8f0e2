// The closed forms of a flight (Eq. 9-10 of the paper): its state, and the gap with its time derivatives.
#pragma once

#include "afm/spring_constants.h"
#include "afm/state.h"
#include "afm/surface.h"
#include "rounded.h"
#include "turns.h"

namespace afm::detail {

// The state after the time s from the state `o`. The extensions turn with their rates, each pair by the angle of its
// spring.
template <class T>
FlightState<T> state_after(const SpringConstants<T>& m, const T& eta, const FlightState<T>& o, const T& s) {
  const SinCos<T> h = sin_cos_turn_product(m.ratio, s);
  const SinCos<T> v = sin_cos_turns(s);
  const T X = mul_add(o.X, h.cos, T(divide_by_omega(o.U, m.omega_h, m.inverse_omega_h) * h.sin));
  const T U = mul_add(o.U, h.cos, T(-(m.omega_h * o.X) * h.sin));
  const T Y = mul_add(o.Y, v.cos, T(divide_by_omega(o.W, m.omega_v, m.inverse_omega_v) * v.sin));
  const T W = mul_add(o.W, v.cos, T(-(m.omega_v * o.Y) * v.sin));
  return {o.phase + (turn_product(eta, s) + (X - o.X)), X, U, Y, W};
}

// With h'' = -k^2 h, h''' = -k^2 h', x'' = -omega_h^2 X and y'' = -omega_v^2 Y.
template <class T>
T second_derivative(const SpringConstants<T>& m, const T& X, const T& u, const T& Y, const T& h, const T& h1) {
  const T k2 = two_pi<T>() * two_pi<T>(), wh2 = m.omega_h * m.omega_h, wv2 = m.omega_v * m.omega_v;
  return mul_add(h, T(k2 * u * u), mul_add(h1, T(wh2 * X), T(-wv2 * Y)));
}
// The same from the gap instead of Y: Y = h - y0 + g. The height h is known last, and only one product waits for it.
template <class T>
T second_derivative_above(const SpringConstants<T>& m, const SurfaceJet<T>& surface, const T& g, const T& X,
                          const T& u) {
  const T k2 = two_pi<T>() * two_pi<T>(), wh2 = m.omega_h * m.omega_h, wv2 = m.omega_v * m.omega_v;
  const T rest = mul_add(surface.h1, T(wh2 * X), T(wv2 * (m.y0 - g)));
  return mul_add(surface.h, mul_add(T(k2 * u), u, T(-wv2)), rest);
}
template <class T>
T third_derivative(const SpringConstants<T>& m, const FlightState<T>& q, const T& u, const T& h, const T& h1) {
  const T k2 = two_pi<T>() * two_pi<T>(), wh2 = m.omega_h * m.omega_h, wv2 = m.omega_v * m.omega_v;
  const T straight = mul_add(T(k2 * u * u), u, T(wh2 * q.U)), bend = T(-3.0) * k2 * u * (wh2 * q.X);
  return mul_add(h1, straight, mul_add(h, bend, T(-wv2 * q.W)));
}

// The jet at a launch.
template <class T>
GapJet<T> jet_at_launch(const SpringConstants<T>& m, const T& eta, const TipState& launch) {
  const SurfaceJet<T> surface = surface_jet(m.H, T(launch.phase));
  const T W = mul_add(surface.h1, T(launch.u), T(launch.g1));
  const T Y = (surface.h - m.y0) + T(launch.g);
  const T X = T(launch.X), u = T(launch.u);
  const T g2 = second_derivative_above(m, surface, T(launch.g), X, u);
  const FlightState<T> state{T(launch.phase), X, u - eta, Y, W};
  return {T(launch.g), T(launch.g1), g2,        third_derivative(m, state, u, surface.h, surface.h1),
          state,       surface.h,    surface.h1};
}

template <class T>
GapJet<T> jet_at(const SpringConstants<T>& m, const T& eta, const FlightState<T>& q) {
  const SurfaceJet<T> surface = surface_jet(m.H, q.phase);
  const T u = eta + q.U;
  return {(q.Y + m.y0) - surface.h,
          mul_add(T(-surface.h1), u, q.W),
          second_derivative(m, q.X, u, q.Y, surface.h, surface.h1),
          third_derivative(m, q, u, surface.h, surface.h1),
          q,
          surface.h,
          surface.h1};
}

// The jet at a time t after `jet`. Terms that cancel are removed on paper, so the change of the gap is exact to a few
// ulp of itself (Lemma 7). Precondition: is_small() of t. The terms linear in t combine to g1 t. The rest is of the
// second order, and each of its terms is exact to a few ulp.
template <class T>
inline GapJet<T> advance_jet(const SpringConstants<T>& m, const T& eta, const GapJet<T>& jet, const T& t) {
  const FlightState<T>& o = jet.state;
  const T k = two_pi<T>(), per = m.inverse_omega_v, u0 = eta + o.U;
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
  const T du_cos = mul_add(T(-u), d.versine, du);  // change of u cos(2 pi dx)
  const T g1 = jet.g1 - mul_add(T(-k * jet.h * u), d.sin, mul_add(jet.h1, du_cos, brake));

  const T h_now = jet.h + mul_add(T(jet.h1 * per), d.sin, T(-jet.h * d.versine));
  const T h1_now = jet.h1 - mul_add(jet.h1, d.versine, T(k * jet.h * d.sin));
  const FlightState<T> q{o.phase + dx, o.X + mul_add(o.U, t, dx2), o.U + du, o.Y + mul_add(o.W, t, dY2), o.W - brake};
  return {g,     g1,    second_derivative(m, q.X, u, q.Y, h_now, h1_now), third_derivative(m, q, u, h_now, h1_now), q,
          h_now, h1_now};
}

}  // namespace afm::detail
