// The rates of the averaged law (afm/detail/chatter_rates.h), for numbers and for dual numbers.
// docs/derive_chatter_law.py derives the coefficients; the pairing of terms shortens the chain of dependent operations.
#pragma once

#include <cmath>
#include <limits>

#include "afm/detail/chatter_rates.h"
#include "afm/detail/select.h"
#include "portable_exp.h"

namespace afm {

constexpr double kThird = 1.0 / 3.0;
// [a/tau] of v without a cutoff, so that 1/v is a number
constexpr double kLeastSpeed = std::numeric_limits<double>::min();

// The coefficients that follow from P, its derivatives, K and K1.
template <class T>
inline void set_reaction_terms(ChatterSurroundingsOf<T>& at) {
  const T inverse_P = T(1.0) / at.P, inverse_P2 = inverse_P * inverse_P, K = at.K;
  const T p1 = at.P1 * inverse_P, p2 = at.P2 * inverse_P, p3 = at.P3 * inverse_P, p1_2 = p1 * p1;
  at.inverse_P = inverse_P;
  at.c_speed = T(kThird) * p1;
  at.c_duration = mul_add(T(3.0 / 27), p2, mul_add(T(-4.0 / 27), p1_2, T(T(-kThird) * K))) * inverse_P2;
  const T bent = mul_add(T(T(-0.2) * K), p1, T(at.K1 * T(1.0 / 15)));
  at.c_speed3 = mul_add(T(-3.0 / 135), p3, mul_add(T(T(20.0 / 135) * p1), T(p2 - p1_2), bent)) * inverse_P2;
  at.c_loss = T(T(kThird) * K) * inverse_P2;
  at.c_loss_w = mul_add(T(0.5), K, T(mul_add(T(-2.0 / 3), p1_2, p2) * T(1.0 / 9))) * inverse_P2;
}

// The reaction at the displaced place over that on the reference slide, minus 1. The bounces keep v^3/P.
template <class T>
inline T disturbance(const ChatterSurroundingsOf<T>& at, const T& sigma, const T& p) {
  return mul_add(T(T(2.0) * at.turn_rate), p, T(-at.c_height * sigma)) * at.inverse_P;
}

// The flow that interpolates w -> w (1 - w): R = G/T, and 1/T.
template <class T>
inline T series_R(const T& w) {
  const T w2 = w * w;
  const T low = mul_add(w2, mul_add(w, T(7.0 / 8), T(7.0 / 12)), mul_add(w, T(0.5), T(1.0)));
  return mul_add(T(w2 * w2), mul_add(w2, T(264917.0 / 60480), mul_add(w, T(727.0 / 288), T(1049.0 / 720))), low);
}
template <class T>
inline T series_1_over_T(const T& w) {
  const T w2 = w * w;
  const T low = mul_add(T(-w2), mul_add(w, T(5.0 / 8), T(5.0 / 12)), mul_add(T(-w), T(0.5), T(1.0)));
  return mul_add(T(-w2 * w2), mul_add(w2, T(261679.0 / 60480), mul_add(w, T(629.0 / 288), T(811.0 / 720))), low);
}

// Under a changing reaction ln v changes by P'/3P (1 - w^2 S)/T, and bounces come later by the part (v P'/3P^2) w D.
template <class T>
inline T series_S(const T& w) {
  return mul_add(T(w * w), mul_add(w, T(2423.0 / 360), T(119.0 / 45)), w + T(1.0 / 3));
}
template <class T>
inline T series_D(const T& w) {
  return mul_add(T(w * w), mul_add(w, T(1477.0 / 180), T(259.0 / 90)), w + T(1.0 / 3));
}

template <class T>
inline T chatter_speed(const ChatterFlow& flow, const T& x) {
  using std::max;
  return flow.geometric ? T(max(x, T(kLeastSpeed))) : portable_exp(x);
}

// The time derivatives. In `c` the speed is what it would be on the reference slide itself. Products of two terms of
// the second order are of the fourth order and left out.
template <class T>
inline SmoothChatterOf<T> chatter_rate(const ChatterFlow& flow, const ChatterSurroundingsOf<T>& at,
                                       double n_per_inverse_v, const SmoothChatterOf<T>& c) {
  const T one(1.0), third(kThird), half(0.5), undisturbed = chatter_speed(flow, c.x), inverse_v = one / undisturbed;
  const T more = disturbance(at, c.sigma, c.p), v = mul_add(undisturbed, T(third * more), undisturbed), v2 = v * v;
  const T height = v2 * (third * at.inverse_P), longer = at.c_duration * v2,
          longer2 = mul_add(T(-longer), longer, longer);
  // bounces per time P/2v, with the disturbed reaction
  const T half_P = half * at.P, bounces = inverse_v * mul_add(half_P, T(T(2.0 * kThird) * more), half_P);
  const T sigma = mul_add(T(T(2.0) * at.turn_rate), height, c.p),
          p = mul_add(at.c_height, height, T(-at.c_sigma * c.sigma));
  const T drift = mul_add(at.x_per_sigma, c.sigma, T(at.x_per_rho * height));
  // mean height of a bounce times P'; v belongs to the start of the bounce, the flow is below it later on
  const T held_work = (flow.is_held_along_x ? at.c_speed : T(0.0)) * v2;
  // relative rates of v from here on
  const T bent = mul_add(T(-at.c_speed), longer2, T(at.c_speed3 * v2));
  if (flow.geometric) {
    const double g = flow.gamma;
    const T rate = mul_add(T(-bounces), longer2, bounces), change = mul_add(T(g - 1.0), rate, at.c_speed + bent);
    return {undisturbed * change,
            mul_add(rate, T(flow.inverse_mean), T(T(flow.n_per_inverse_v) * change)),
            sigma,
            p,
            drift,
            held_work * T(3.0 / (1.0 + g + g * g))};
  }
  const T w = T(flow.loss) * v, later = mul_add(half, w, one), delay = at.c_speed * at.inverse_P * v * w * series_D(w);
  const T inverse_T = series_1_over_T(w), lost = mul_add(v2, mul_add(w, at.c_loss_w, at.c_loss), series_R(w));
  const T squeezed = T(at.c_speed * inverse_T) * mul_add(T(-w * w), series_S(w), one);
  const T change = mul_add(bent, later, mul_add(T(-w), T(bounces * lost), squeezed));
  const T rate = mul_add(T(-longer2), later, mul_add(T(-inverse_T), delay, inverse_T));
  return {change, mul_add(bounces, rate, T(T(n_per_inverse_v) * inverse_v * change)),
          sigma,  p,
          drift,  mul_add(held_work, w, held_work)};
}

template <class T>
inline T smooth_speed(const ChatterFlow& flow, const T& v) {
  return flow.geometric ? v : portable_log(v);
}

// The part of n that is not in `rest`.
template <class T>
inline T bounces_at(const ChatterFlow& flow, double n_per_inverse_v, const T& v) {
  return flow.geometric ? T(T(-flow.n_per_inverse_v) * portable_log(v)) : T(T(n_per_inverse_v) / v);
}

// To the smooth variables, and back.
template <class T>
inline SmoothChatterOf<T> to_smooth(const ChatterFlow& flow, const ChatterSurroundingsOf<T>& at, double n_per_inverse_v,
                                    const ChatterOf<T>& c) {
  const T v = c.v * mul_add(T(-kThird), disturbance(at, c.sigma, c.p), T(1.0));
  return {smooth_speed(flow, v), c.n - bounces_at(flow, n_per_inverse_v, v), c.sigma, c.p, c.drift, c.held_work};
}
template <class T>
inline ChatterOf<T> from_smooth(const ChatterFlow& flow, const ChatterSurroundingsOf<T>& at, double n_per_inverse_v,
                                const SmoothChatterOf<T>& c) {
  const T v = chatter_speed(flow, c.x);
  return {v * mul_add(T(kThird), disturbance(at, c.sigma, c.p), T(1.0)),
          c.rest + bounces_at(flow, n_per_inverse_v, v),
          c.sigma,
          c.p,
          c.drift,
          c.held_work};
}

}  // namespace afm
