// One bounce along the reference slide: the solution of rho'' = -P(t) - K(t) rho to the third order of its duration 2
// v/P (docs/derive_chatter_law.py). It serves bounces that lose too large a part of their speed for the averages of
// chatter_flow.h: above the cutoff, or not far below it. For numbers and for dual numbers.
#pragma once

#include <algorithm>

#include "afm/detail/chatter_rates.h"
#include "afm/detail/select.h"
#include "chatter_flow.h"

namespace afm {

// The reaction a time t after a known one, and its time derivatives over the reaction: p1 = P'/P and so on.
template <class T>
struct Reaction {
  T P, inverse_P, p1, p2, p3;
};

template <class T>
inline Reaction<T> later(const ChatterSurroundingsOf<T>& at, const T& t) {
  const T P = mul_add(t, mul_add(t, mul_add(t, T(at.P3 * T(1.0 / 6)), T(T(0.5) * at.P2)), at.P1), at.P);
  const T inverse_P = T(1.0) / P;
  return {P, inverse_P, mul_add(t, mul_add(t, T(T(0.5) * at.P3), at.P2), at.P1) * inverse_P,
          mul_add(t, at.P3, at.P2) * inverse_P, at.P3 * inverse_P};
}

// A bounce that is launched at v: how long it lasts [tau], and the normal speed before the impact that ends it [a/tau].
template <class T>
struct BounceArc {
  T duration, speed;
};

template <class T>
inline BounceArc<T> arc_of(const Reaction<T>& r, const ChatterSurroundingsOf<T>& at, const T& v) {
  const T q = T(2.0) * v * r.inverse_P, p1 = r.p1, p2 = r.p2, p1_2 = p1 * p1, K = at.K;
  const T longer2 = mul_add(T(8.0), p1_2, T(T(-3.0) * (p2 + K))) * T(1.0 / 36), longer1 = T(-kThird) * p1;
  const T inner = p1 * mul_add(T(100.0), p1_2, mul_add(T(-75.0), p2, T(T(-54.0) * K)));
  const T longer3 = -(mul_add(T(18.0), at.K1, inner) + T(9.0) * r.p3) / T(540.0);
  const T faster2 = mul_add(T(-2.0 / 9), p1_2, T(p2 * T(1.0 / 6)));
  const T faster3 = mul_add(p1, mul_add(T(5.0 / 27), p1_2, mul_add(T(-2.0 / 9), p2, T(T(-0.05) * K))),
                            mul_add(T(1.0 / 60), at.K1, T(T(0.05) * r.p3)));
  return {q * mul_add(q, mul_add(q, mul_add(q, longer3, longer2), longer1), T(1.0)),
          v * mul_add(q, mul_add(q, mul_add(q, faster3, faster2), T(T(kThird) * p1)), T(1.0))};
}

// The normal speed after an impact at v (the restitution law, section III of the paper). max_loss = 1 - gamma.
template <class T>
inline T speed_after(double max_loss, const ChatterFlow& flow, const T& v) {
  using std::min;
  return v * (T(1.0) - min(T(max_loss), T(T(flow.loss) * v)));
}

// The displacement from the reference slide after a part dt of a bounce, by its mean height v^2/(3 P).
template <class T>
inline ChatterOf<T> moved(const ChatterSurroundingsOf<T>& at, const Reaction<T>& r, const T& dt, bool is_held_along_x,
                          const ChatterOf<T>& c) {
  const T height = T(kThird) * c.v * c.v * r.inverse_P * dt, P1 = r.p1 * r.P;
  const T p = mul_add(at.c_height, height, mul_add(T(-at.c_sigma * c.sigma), dt, c.p));
  return {c.v,
          c.n,
          mul_add(T(T(2.0) * at.turn_rate), height, mul_add(T(T(0.5) * (c.p + p)), dt, c.sigma)),
          p,
          mul_add(at.x_per_rho, height, mul_add(T(at.x_per_sigma * c.sigma), dt, c.drift)),
          is_held_along_x ? mul_add(P1, height, c.held_work) : c.held_work};
}

}  // namespace afm
