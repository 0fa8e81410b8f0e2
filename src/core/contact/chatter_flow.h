// The rates of chatter_rates.h, written once for a number, for one with derivatives, and for four side by side (`Four`):
// one for each node of a step of their integrator. All give the same bits.
#pragma once

#include <cmath>
#include <limits>

#include "afm/detail/chatter_rates.h"
#include "afm/detail/multiversion.h"
#include "afm/detail/select.h"
#include "collocation.h"
#include "portable_exp.h"

namespace afm {

constexpr double kThird = 1.0 / 3.0;

// What follows from the reaction, its derivatives and K.
template <class T>
AFM_INLINED void set_reaction_terms(ChatterSurroundingsOf<T>& at) {
  const T inverse_P = T(1.0) / at.P, inverse_P2 = inverse_P * inverse_P, K = at.bend;
  const T p1 = at.P1 * inverse_P, p2 = at.P2 * inverse_P, p3 = at.P3 * inverse_P, p1_2 = p1 * p1;
  at.inverse_P = inverse_P;
  at.c_speed = T(kThird) * p1;
  at.c_duration = mul_add(T(3.0 / 27), p2, mul_add(T(-4.0 / 27), p1_2, T(T(-kThird) * K))) * inverse_P2;
  const T bent = mul_add(T(T(-0.2) * K), p1, T(at.K1 * T(1.0 / 15)));
  at.c_speed3 = mul_add(T(-3.0 / 135), p3, mul_add(T(T(20.0 / 135) * p1), T(p2 - p1_2), bent)) * inverse_P2;
  at.c_loss = T(T(kThird) * K) * inverse_P2;
  at.c_loss_w = mul_add(T(0.5), K, T(mul_add(T(-2.0 / 3), p1_2, p2) * T(1.0 / 9))) * inverse_P2;
}

// At every node of a step of which both ends are known, without relative_rate and speeds. The reaction is interpolated to
// the order 8, what is only in terms of the second order evenly.
template <class T>
AFM_INLINED ChatterSurroundingsOf<T> between(const ChatterSurroundings& first, const ChatterSurroundings& last,
                                             double dt) {
  const auto at_nodes = [](double a, double b) {
    return mul_add(at_every_node<T>(kNodes), T(b), T(at_every_node<T>(kRest) * T(a)));
  };
  const HermiteOf<T> P = hermite<T>(dt, {first.P, first.P1, first.P2, first.P3}, {last.P, last.P1, last.P2, last.P3});
  ChatterSurroundingsOf<T> at;
  at.P = P.value, at.P1 = P.slope, at.P2 = P.bend;
  at.P3 = at_nodes(first.P3, last.P3);
  at.bend = at_nodes(first.bend, last.bend), at.K1 = at_nodes(first.K1, last.K1);
  set_reaction_terms(at);
  at.turn = at_nodes(first.turn, last.turn);
  at.c_height = at_nodes(first.c_height, last.c_height), at.stiffness = at_nodes(first.stiffness, last.stiffness);
  at.along = at_nodes(first.along, last.along), at.up = at_nodes(first.up, last.up);
  return at;
}

// The reaction off the reference slide over that on it, less 1. The action keeps v^3/P.
template <class T>
AFM_INLINED T disturbance(const ChatterSurroundingsOf<T>& at, const T& sigma, const T& p) {
  return mul_add(T(T(2.0) * at.turn), p, T(-at.c_height * sigma)) * at.inverse_P;
}

// The interpolation of w -> w (1 - w): R = G/T and 1/T. Terms are paired, to shorten the chain of dependencies.
template <class T>
AFM_INLINED T series_R(const T& w) {
  const T w2 = w * w;
  const T low = mul_add(w2, mul_add(w, T(7.0 / 8), T(7.0 / 12)), mul_add(w, T(0.5), T(1.0)));
  return mul_add(T(w2 * w2), mul_add(w2, T(264917.0 / 60480), mul_add(w, T(727.0 / 288), T(1049.0 / 720))), low);
}
template <class T>
AFM_INLINED T series_1_over_T(const T& w) {
  const T w2 = w * w;
  const T low = mul_add(T(-w2), mul_add(w, T(5.0 / 8), T(5.0 / 12)), mul_add(T(-w), T(0.5), T(1.0)));
  return mul_add(T(-w2 * w2), mul_add(w2, T(261679.0 / 60480), mul_add(w, T(629.0 / 288), T(811.0 / 720))), low);
}

// The same of a pressure that changes: what it changes ln v by is P'/3P (1 - w^2 S)/T, and bounces come later by the
// part (v P'/3P^2) w D.
template <class T>
AFM_INLINED T series_S(const T& w) {
  return mul_add(T(w * w), mul_add(w, T(2423.0 / 360), T(119.0 / 45)), w + T(1.0 / 3));
}
template <class T>
AFM_INLINED T series_D(const T& w) {
  return mul_add(T(w * w), mul_add(w, T(1477.0 / 180), T(259.0 / 90)), w + T(1.0 / 3));
}

constexpr double kLeastSpeed = std::numeric_limits<double>::min();

template <class T>
AFM_INLINED T chatter_speed(const ChatterFlow& flow, const T& x) {
  using std::max;
  return flow.geometric ? T(max(x, T(kLeastSpeed))) : portable_exp(x);
}

// d/dt. In `c` v stands for what it would be on the reference slide itself. Products of two terms of the second order are of the
// fourth, and left out.
template <class T>
AFM_INLINED SmoothChatterOf<T> chatter_rate(const ChatterFlow& flow, const ChatterSurroundingsOf<T>& at, double part,
                                          const SmoothChatterOf<T>& c) {
  const T one(1.0), third(kThird), half(0.5), on_slide = chatter_speed(flow, c.x), inverse_v = one / on_slide;
  const T more = disturbance(at, c.sigma, c.p), v = mul_add(on_slide, T(third * more), on_slide), v2 = v * v;
  const T height = v2 * (third * at.inverse_P), longer = at.c_duration * v2,
          longer2 = mul_add(T(-longer), longer, longer);
  const T even = half * at.P, bounces = inverse_v * mul_add(even, T(T(2.0 * kThird) * more), even);
  const T sigma = mul_add(T(T(2.0) * at.turn), height, c.p),
          p = mul_add(at.c_height, height, T(-at.stiffness * c.sigma));
  const T drift = mul_add(at.along, c.sigma, T(at.up * height));
  // the mean height of a bounce times P'; v is that of its beginning, of which the flow is less later on
  const T lift = (flow.held ? at.c_speed : T(0.0)) * v2;
  // of ln v, as are those below
  const T bent = mul_add(T(-at.c_speed), longer2, T(at.c_speed3 * v2));
  if (flow.geometric) {
    const double g = flow.gamma;
    const T rate = mul_add(T(-bounces), longer2, bounces), change = mul_add(T(g - 1.0), rate, at.c_speed + bent);
    return {on_slide * change,
            mul_add(rate, T(flow.inverse_mean), T(T(flow.even) * change)),
            sigma,
            p,
            drift,
            lift * T(3.0 / (1.0 + g + g * g))};
  }
  const T w = T(flow.loss) * v, later = mul_add(half, w, one), delay = at.c_speed * at.inverse_P * v * w * series_D(w);
  const T inverse_T = series_1_over_T(w), lost = mul_add(v2, mul_add(w, at.c_loss_w, at.c_loss), series_R(w));
  const T squeezed = T(at.c_speed * inverse_T) * mul_add(T(-w * w), series_S(w), one);
  const T change = mul_add(bent, later, mul_add(T(-w), T(bounces * lost), squeezed));
  const T rate = mul_add(T(-longer2), later, mul_add(T(-inverse_T), delay, inverse_T));
  return {change, mul_add(bounces, rate, T(T(part) * inverse_v * change)), sigma, p, drift, mul_add(lift, w, lift)};
}

template <class T>
AFM_INLINED T smooth_speed(const ChatterFlow& flow, const T& v) {
  return flow.geometric ? v : portable_log(v);
}

// What of n is not in `rest`.
template <class T>
AFM_INLINED T bounces_at(const ChatterFlow& flow, double part, const T& v) {
  return flow.geometric ? T(T(-flow.even) * portable_log(v)) : T(T(part) / v);
}

// The variables that change evenly, and back.
template <class T>
AFM_INLINED SmoothChatterOf<T> to_smooth(const ChatterFlow& flow, const ChatterSurroundingsOf<T>& at, double part,
                                     const ChatterOf<T>& c) {
  const T v = c.v * mul_add(T(-kThird), disturbance(at, c.sigma, c.p), T(1.0));
  return {smooth_speed(flow, v), c.n - bounces_at(flow, part, v), c.sigma, c.p, c.drift, c.lift};
}
template <class T>
AFM_INLINED ChatterOf<T> to_plain(const ChatterFlow& flow, const ChatterSurroundingsOf<T>& at, double part,
                                  const SmoothChatterOf<T>& c) {
  const T v = chatter_speed(flow, c.x);
  return {v * mul_add(T(kThird), disturbance(at, c.sigma, c.p), T(1.0)),
          c.rest + bounces_at(flow, part, v),
          c.sigma,
          c.p,
          c.drift,
          c.lift};
}

// start and the integrals over dt to each node: of the rates at the beginning and at the nodes.
template <class T>
AFM_INLINED SmoothChatterOf<T> collocated(double dt, const SmoothChatter& start, const SmoothChatter& first,
                                        const SmoothChatterOf<T>& rates) {
  const auto sum = [&](double SmoothChatter::*of, const T& rate) {
    const auto weight = [&](std::size_t k) { return T(T(dt) * at_every_node<T>(kLobatto[k])); };
    T x = mul_add(weight(0), T(first.*of), T(start.*of));
    x = mul_add(weight(1), first_of(rate), x);
    x = mul_add(weight(2), second_of(rate), x);
    x = mul_add(weight(3), third_of(rate), x);
    return mul_add(weight(4), last_of(rate), x);
  };
  return {sum(&SmoothChatter::x, rates.x), sum(&SmoothChatter::rest, rates.rest),   sum(&SmoothChatter::sigma, rates.sigma),
          sum(&SmoothChatter::p, rates.p), sum(&SmoothChatter::drift, rates.drift), sum(&SmoothChatter::lift, rates.lift)};
}

// From what `to` begins with at `from`, without its own part of n, to what that changes to, and how fast it goes on;
// what is around it is known. From what the first rate foretells, three times: where w is 0.1 it leaves a part in 1e7
// of what a step changes.
template <class T>
AFM_INLINED void node_step(const ChatterFlow& flow, const ChatterPlace& from, double dt, ChatterPlace& to) {
  const ChatterSurroundingsOf<T> at = between<T>(from.around, to.around, dt);
  const T time = at_every_node<T>(kNodes) * T(dt);
  const auto extrapolated = [&](double start, double rate) { return T(T(start) + time * T(rate)); };
  const SmoothChatter e = to.even, r = to.rate;
  const SmoothChatterOf<T> soon{extrapolated(e.x, r.x), extrapolated(e.rest, r.rest),   extrapolated(e.sigma, r.sigma),
                              extrapolated(e.p, r.p), extrapolated(e.drift, r.drift), extrapolated(e.lift, r.lift)};
  const auto again = [&](const SmoothChatterOf<T>& rates) {
    return chatter_rate(flow, at, to.part, collocated(dt, e, r, rates));
  };
  const SmoothChatterOf<T> rates = again(again(chatter_rate(flow, at, to.part, soon)));
  const SmoothChatterOf<T> end = collocated(dt, e, r, rates);
  const auto last = [](const SmoothChatterOf<T>& c) {
    return SmoothChatter{last_number(c.x), last_number(c.rest),  last_number(c.sigma),
                       last_number(c.p), last_number(c.drift), last_number(c.lift)};
  };
  to.even = last(end), to.rate = last(rates);
}

}  // namespace afm
