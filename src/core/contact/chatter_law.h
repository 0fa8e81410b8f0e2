// The averaged law of chatter and its integration (docs/algorithm.md, "Chatter"), for numbers and for dual numbers.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include "afm/detail/chatter.h"
#include "lobatto.h"
#include "core/portable_exp.h"
#include "reference_forces.h"

namespace afm::detail {

// docs/algorithm.md has a table of the error with each of them changed.
struct ChatterLimits {
  static constexpr double kMaxLoss = 0.1;            // w at the entry
  static constexpr double kMaxRatioAtEntry = 0.06;   // adiabaticity ratio at the entry
  static constexpr double kMaxRatioWithin = 0.08;    // the same within a sequence
  static constexpr double kDefaultThreshold = 1e-5;  // [a/tau] below it the limits above and the steps are smaller

  static constexpr double kAccepted = 1.05;     // ratio over its limit, up to which a sequence may exit
  static constexpr double kMaxFall = 2.0;       // fall of ln v in a step
  static constexpr double kStep = 0.5;          // step over the time in which P changes, or v falls to zero
  static constexpr double kMaxChange = 1.6;     // step over the time in which P changes at its end, or it is halved
  static constexpr double kEndSpeed = 0.9;      // v over the threshold that the last step aims at
  static constexpr double kNearlyWhole = 1e-3;  // bounces: so near a whole n the rates count as constant
};

// The coefficients of the law, functions of the part w of v that a bounce loses.
template <class T>
struct LossCoefficients {
  T w, R, M, G, C, D;
};

template <class T>
inline LossCoefficients<T> loss_coefficients(const ChatterConstants& c, const T& v) {
  const double gamma = 1.0 - c.w;
  if (c.constant_loss) return {T(c.w), T(1.0), T(c.M), T(1.0), T(3.0 / (1.0 + gamma + gamma * gamma)), T(0.0)};
  const T w = c.dw_dv * v, w2 = w * w;
  const T R = (1.0 + 0.5 * w) + w2 * (7.0 / 12 + (7.0 / 8) * w), M = (1.0 - 0.5 * w) - w2 * (5.0 / 12 + (5.0 / 8) * w);
  return {w, R, M, M * (1.0 - (1.0 / 3) * w2), 1.0 + w, T(1.0 / 9)};
}

// The variables of the integration. x changes slowly: it is ln v, or with a constant loss v itself.
template <class T>
struct ChatterVariables {
  T x, n, sigma, p, drift, loss;
};

// The values at the nodes of a step. The compiler makes vector operations of the loops over the nodes, with the same
// bits.
template <class T>
using AtNodes = T[kNodeCount];

template <class T>
inline void set_node(ReferenceForces<AtNodes<T>>& at, std::size_t i, const ReferenceForces<T>& f) {
  at.P[i] = f.P, at.P1[i] = f.P1, at.P2[i] = f.P2, at.K[i] = f.K, at.turn[i] = f.turn;
  at.c_height[i] = f.c_height, at.c_sigma[i] = f.c_sigma, at.dx_dsigma[i] = f.dx_dsigma, at.dx_drho[i] = f.dx_drho;
}
template <class T>
inline ReferenceForces<T> node(const ReferenceForces<AtNodes<T>>& at, std::size_t i) {
  return {at.P[i],        at.P1[i],      at.P2[i],        at.K[i],      at.turn[i],
          at.c_height[i], at.c_sigma[i], at.dx_dsigma[i], at.dx_drho[i]};
}
template <class T>
inline void set_node(ChatterVariables<AtNodes<T>>& at, std::size_t i, const ChatterVariables<T>& y) {
  at.x[i] = y.x, at.n[i] = y.n, at.sigma[i] = y.sigma, at.p[i] = y.p, at.drift[i] = y.drift, at.loss[i] = y.loss;
}
template <class T>
inline ChatterVariables<T> node(const ChatterVariables<AtNodes<T>>& at, std::size_t i) {
  return {at.x[i], at.n[i], at.sigma[i], at.p[i], at.drift[i], at.loss[i]};
}

// A time of the integration.
template <class T>
struct ChatterPoint {
  T s;  // since the start of the reference slide [tau]
  ReferenceForces<T> forces;
  ChangeRates changes;
  ChatterVariables<T> y, rates;
  ChatterOf<T> chatter;
};

// e: the change of the reaction by the displacement, over P.
template <class T>
inline T disturbance(const ReferenceForces<T>& f, const T& sigma, const T& p) {
  return (2.0 * f.turn * p - f.c_height * sigma) / f.P;
}

// The bounces keep v^3/P, so v = v_0 (1 + e/3), where v_0 is that on the reference slide.
template <class T>
inline T chatter_speed(const ChatterConstants& c, const T& x, const T& e) {
  return (c.constant_loss ? x : portable_exp(x)) * (1.0 + e * (1.0 / 3));
}

template <class T>
inline ChatterOf<T> to_chatter(const ChatterConstants& c, const ReferenceForces<T>& f, const ChatterVariables<T>& y) {
  return {chatter_speed(c, y.x, disturbance(f, y.sigma, y.p)), y.n, y.sigma, y.p, y.drift, y.loss};
}

// The law: the time derivatives of the variables.
template <class T>
inline ChatterVariables<T> chatter_rates(const ChatterConstants& c, const ReferenceForces<T>& f,
                                         const ChatterVariables<T>& y) {
  constexpr double kThird = 1.0 / 3;
  const T e = disturbance(f, y.sigma, y.p), v = chatter_speed(c, y.x, e), half_P = 0.5 * f.P * (1.0 + e);
  const T inverse_P = 1.0 / f.P, p1 = f.P1 * inverse_P, p2 = f.P2 * inverse_P, p1_3 = kThird * p1;
  const T d = (3.0 * p2 - 4.0 * p1 * p1 - 9.0 * f.K) * (inverse_P * inverse_P) * (1.0 / 27);
  const auto [w, R, M, G, C, D] = loss_coefficients(c, v);
  const T rho = C * v * v * (kThird * inverse_P);
  return {c.constant_loss ? G * v * p1_3 - half_P * (w * R) : G * p1_3 - half_P * (c.dw_dv * R),
          M * half_P / v * (1.0 - v * (d * v + D * w * p1 * inverse_P)),
          y.p + 2.0 * f.turn * rho,
          f.c_height * rho - f.c_sigma * y.sigma,
          f.dx_dsigma * y.sigma + f.dx_drho * rho,
          v * (half_P * (w * R) + v * p1_3 * (C - G))};
}

// Duration of a bounce [tau].
template <class T>
inline T bounce_duration(const ChatterPoint<T>& at) {
  return 1.0 / at.rates.n;
}

// The adiabaticity ratio over its limit within a sequence.
template <class T>
inline double ratio_over_limit(const ChatterConstants& c, const ChatterPoint<T>& at) {
  const double limit = ChatterLimits::kMaxRatioWithin * c.fineness;
  const double P = static_cast<double>(at.forces.P);
  if (!(P > 0.0)) return std::numeric_limits<double>::infinity();
  return 2.0 * static_cast<double>(at.chatter.v) / P * at.changes.fastest / limit;
}

// The integration along one reference slide.
template <class T>
class ChatterIntegration {
 public:
  using Point = ChatterPoint<T>;
  using Run = ChatterRunOf<T>;

  ChatterIntegration(const ChatterConstants& constants, const SlideSegment<T>& reference)
      : c_(constants), reference_(reference) {}

  Point begin(const T& s, const ChatterOf<T>& start) const {
    const SlideState<T> q = reference_.at(s);
    const ReferenceForces<T> f = reference_forces(reference_.springs(), reference_.eta(), q);
    const T v = start.v * (1.0 - disturbance(f, start.sigma, start.p) * (1.0 / 3));
    const T x = c_.constant_loss ? v : portable_log(v);
    const ChatterVariables<T> y{x, start.n, start.sigma, start.p, start.drift, start.loss};
    Point at{s, f, change_rates(reference_.springs(), q.u, f), y, {}, start};
    at.rates = chatter_rates(c_, at.forces, at.y);
    return at;
  }

  // From the start to `until`, or to the end of the sequence. Without `exits` the adiabaticity ratio is not checked:
  // that is for a state in the middle of a known sequence.
  Run follow(double until, const ChatterOf<T>& start, bool exits) const {
    Point now = begin(T(0.0), start);
    while (value(now.s) < until && value(now.chatter.v) > c_.threshold) {
      const double first = ratio_over_limit(c_, now);
      if (exits && !(first <= 1.0)) return exit_at(now, whole_after(now));
      double dt = step_length(now, until - value(now.s));
      Point next;
      for (;; dt *= 0.5) {
        if (!(value(now.s) + dt > value(now.s))) return {ChatterEnd::exits, now.s, now.chatter};
        next = step(now, dt);
        if (fits(now, dt, next)) break;
      }
      if (exits && !(ratio_over_limit(c_, next) <= 1.0)) return exit_at(now, last_whole(now, first, next, dt));
      if (value(next.chatter.v) <= c_.threshold) next.chatter.n = count_at_threshold(now, dt, next);
      now = next;
    }
    return {value(now.chatter.v) <= c_.threshold ? ChatterEnd::died : ChatterEnd::time, now.s, now.chatter};
  }

  // The bounce at which n is N, near `from`. Neighbouring starts end with the same bounce, not at the same time. If the
  // reaction vanishes before that bounce: `from` itself.
  Run exit_at(const Point& from, double N) const {
    constexpr int kMaxTries = 10;  // Newton's method takes two
    Point at = from;
    double dt = 0.0;
    for (int i = 0; i < kMaxTries; ++i) {
      const T rest = (N - at.y.n) * bounce_duration(at);
      if (std::abs(N - value(at.y.n)) <= ChatterLimits::kNearlyWhole) {
        ChatterOf<T> end = to_chatter(c_, at.forces, along(at, rest));
        end.n = T(N);
        return {ChatterEnd::exits, at.s + rest, end};
      }
      dt += value(rest);
      at = step(from, dt);
      if (!fits(from, std::abs(dt), at)) break;
    }
    return {ChatterEnd::exits, from.s, from.chatter};
  }

 private:
  static double value(const T& x) { return static_cast<double>(x); }
  static double whole_after(const Point& at) { return std::floor(value(at.y.n)) + 1.0; }

  // The bounces of a step that ends below the threshold, down to it. The speed may rise before it falls.
  T count_at_threshold(const Point& from, double dt, const Point& end) const {
    constexpr int kMaxTries = 30;          // one is enough where the speed falls evenly
    constexpr double kNearlyThere = 0.03;  // of the step: then the rates count as constant
    const auto above = [&](const Point& at) { return portable_log(value(at.chatter.v) / c_.threshold); };
    double low = 0.0, high = 1.0, over = above(from), under = above(end);
    T n = end.y.n;
    for (int i = 0; i < kMaxTries; ++i) {
      const double part = low + (high - low) * (over / (over - under));
      const Point at = step(from, part * dt);
      const double rest = above(at), falls = value(at.rates.x) / (c_.constant_loss ? value(at.chatter.v) : 1.0);
      n = at.y.n;
      if (falls < 0.0 && std::abs(rest) <= kNearlyThere * dt * -falls) return n - (rest / falls) * at.rates.n;
      (rest > 0.0 ? low : high) = part;
      (rest > 0.0 ? over : under) = rest;
      (rest > 0.0 ? under : over) *= 0.5;  // or one end might stay for ever
    }
    return n;
  }

  // The last whole n of a step before the adiabaticity ratio reaches its limit, or the first whole n of the step. Near
  // the zero of the reaction the ratio grows like (t_end - t)^(-5/3) (docs/algorithm.md, "Exit"), so its inverse root
  // is nearly linear in time.
  double last_whole(const Point& from, double first, Point to, double dt) const {
    constexpr int kMaxTries = 4;  // one is enough, except where P passes its maximum
    for (int i = 0; i < kMaxTries; ++i) {
      const double last = ratio_over_limit(c_, to);
      if (last <= ChatterLimits::kAccepted) return std::max(whole_after(from), std::floor(value(to.y.n)));
      const double left = 1.0 / std::sqrt(first) - 1.0, over = 1.0 - 1.0 / std::sqrt(last);
      dt *= left / (left + over);
      to = step(from, dt);
    }
    return whole_after(from);
  }

  double step_length(const Point& at, double rest) const {
    const double half_P = 0.5 * value(at.forces.P), v = value(at.chatter.v), x1 = value(at.rates.x);
    const double falls =
        c_.constant_loss ? ChatterLimits::kStep * v / (half_P * c_.w) : ChatterLimits::kMaxFall / (half_P * c_.dw_dv);
    double dt = c_.fineness * std::min(falls, ChatterLimits::kStep / at.changes.change);
    // not far beyond the threshold
    if (x1 < 0.0) dt = std::min(dt, (c_.end_x - value(at.y.x)) / x1);
    return rest <= dt ? rest : rest < 2.0 * dt ? 0.5 * rest : dt;  // the last two steps are equal
  }

  // False: the step must be halved. Its length comes from the rates at its start. On a crest, under a holder that has
  // just started, these rates do not show the motion that follows.
  bool fits(const Point& from, double dt, const Point& next) const {
    // with a constant loss n is like -ln v, with its pole at v = 0
    const double least_v = c_.constant_loss ? 0.5 * (1.0 - ChatterLimits::kStep) * value(from.chatter.v) : 0.0;
    return value(next.forces.P) > 0.0 && dt * next.changes.change <= ChatterLimits::kMaxChange &&
           value(next.chatter.v) > least_v;
  }

  // After so short a time that the rates count as constant.
  ChatterVariables<T> along(const Point& from, const T& dt) const {
    const ChatterVariables<T>&y = from.y, &r = from.rates;
    return {y.x + dt * r.x, y.n + dt * r.n,         y.sigma + dt * r.sigma,
            y.p + dt * r.p, y.drift + dt * r.drift, y.loss + dt * r.loss};
  }

  // The integral of the rates from the start of the step to node i.
  static ChatterVariables<T> integral(const Point& from, double dt, const ChatterVariables<AtNodes<T>>& rates,
                                      std::size_t i) {
    const auto sum = [&](const T& y, const T& first, const AtNodes<T>& at) {
      T mean = kLobatto[0][i] * first;
#pragma GCC unroll 4
      for (std::size_t k = 0; k < kNodeCount; ++k) mean = mean + kLobatto[k + 1][i] * at[k];
      return y + dt * mean;
    };
    const ChatterVariables<T>&y = from.y, &r = from.rates;
    return {sum(y.x, r.x, rates.x),
            sum(y.n, r.n, rates.n),
            sum(y.sigma, r.sigma, rates.sigma),
            sum(y.p, r.p, rates.p),
            sum(y.drift, r.drift, rates.drift),
            sum(y.loss, r.loss, rates.loss)};
  }

  // One step of Lobatto's method. Its equations are solved by iteration; the start extrapolates the first rates.
  Point step(const Point& from, double dt) const {
    constexpr int kIterations = 2;
    constexpr std::size_t kLast = kNodeCount - 1;
    const SlideSegment<T>& reference = reference_;
    const SpringConstants<T> springs = reference.springs();
    const T eta = reference.eta();
    SlideState<AtNodes<T>> q;
    ReferenceForces<AtNodes<T>> forces;
    ChatterVariables<AtNodes<T>> y, rates;
    for (std::size_t i = 0; i < kNodeCount; ++i) {
      const SlideState<T> at = reference.at(from.s + kNodes[i] * dt);
      q.phase[i] = at.phase, q.X[i] = at.X, q.u[i] = at.u;
    }
    for (std::size_t i = 0; i < kNodeCount; ++i) {
      set_node(forces, i, reference_forces(springs, eta, SlideState<T>{q.phase[i], q.X[i], q.u[i]}));
    }
    for (std::size_t i = 0; i < kNodeCount; ++i) set_node(y, i, along(from, T(kNodes[i] * dt)));
    set_rates(forces, y, rates);
    for (int iteration = 0; iteration < kIterations; ++iteration) {
      for (std::size_t i = 0; i < kNodeCount; ++i) set_node(y, i, integral(from, dt, rates, i));
      set_rates(forces, y, rates);
    }
    const ReferenceForces<T> f = node(forces, kLast);
    const ChatterVariables<T> end = integral(from, dt, rates, kLast);
    return {from.s + dt, f, change_rates(springs, q.u[kLast], f), end, node(rates, kLast), to_chatter(c_, f, end)};
  }

  void set_rates(const ReferenceForces<AtNodes<T>>& forces, const ChatterVariables<AtNodes<T>>& y,
                 ChatterVariables<AtNodes<T>>& rates) const {
    c_.constant_loss ? set_rates_of<true>(forces, y, rates) : set_rates_of<false>(forces, y, rates);
  }
  // Without a branch in the loop, which could not be a vector operation.
  template <bool kConstantLoss>
  void set_rates_of(const ReferenceForces<AtNodes<T>>& forces, const ChatterVariables<AtNodes<T>>& y,
                    ChatterVariables<AtNodes<T>>& rates) const {
    ChatterConstants c = c_;
    c.constant_loss = kConstantLoss;
    for (std::size_t i = 0; i < kNodeCount; ++i) set_node(rates, i, chatter_rates(c, node(forces, i), node(y, i)));
  }

  const ChatterConstants& c_;
  const SlideSegment<T>& reference_;
};

}  // namespace afm::detail
