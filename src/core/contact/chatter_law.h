// The averaged law of chatter and its integration (docs/algorithm.md, "Chatter"), for numbers and for dual numbers.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

#include "afm/chatter.h"
#include "afm/detail/multiversion.h"
#include "lobatto.h"
#include "portable_exp.h"
#include "reference_forces.h"

namespace afm {

// Measured with benchmark/burst_error, see the table in docs/algorithm.md. Pure numbers unless a unit is given.
struct ChatterLimits {
  static constexpr double kMaxLoss = 0.1;           // w at the begin of a sequence
  static constexpr double kMaxBounce = 0.06;        // adiabaticity ratio at the begin
  static constexpr double kMaxBounceWithin = 0.08;  // the same within a sequence: only its last bounces reach it
  static constexpr double kUsualThreshold = 1e-5;   // [a/tau] by default; narrower limits below it

  static constexpr double kAccepted = 1.05;     // of that limit, where a sequence exits
  static constexpr double kFall = 2.0;          // of ln v in a step
  static constexpr double kStep = 0.5;          // over the time in which P changes, or v falls to zero
  static constexpr double kMaxChange = 1.6;     // the same at the end of a step, or the step is halved
  static constexpr double kEndSpeed = 0.9;      // v over the threshold, where the last step of a sequence aims
  static constexpr double kNearlyWhole = 1e-3;  // bounces, from where the rates count as constant
};

// The coefficients of the law, functions of the part w of v that a bounce loses.
template <class T>
struct LossCoefficients {
  T w;
  T R, G;  // dv/dt = -(P/2) w R + G v P'/3P
  T M;     // dn/dt = M P/2v
  T C;     // mean height of a bounce: rho = C v^2/3P
};

template <class T>
AFM_INLINED LossCoefficients<T> loss_coefficients(const ChatterConstants& c, const T& v) {
  const double gamma = 1.0 - c.w;
  if (c.constant_loss) return {T(c.w), T(1.0), T(1.0), T(c.M), T(3.0 / (1.0 + gamma + gamma * gamma))};
  const T w = c.w_per_v * v, w2 = w * w;
  const T R = (1.0 + 0.5 * w) + w2 * (7.0 / 12 + (7.0 / 8) * w), M = (1.0 - 0.5 * w) - w2 * (5.0 / 12 + (5.0 / 8) * w);
  return {w, R, M * (1.0 - (1.0 / 3) * w2), M, 1.0 + w};
}

// What is integrated. x changes slowly: ln v, or with a constant loss v itself.
template <class T>
struct ChatterVariables {
  T x, n, sigma, p, drift, loss;
};

// One point of the integration.
template <class T>
struct ChatterPoint {
  T s;  // since the start of the reference slide [tau]
  ReferenceForces<T> forces;
  ChatterVariables<T> y, rates;
  ChatterOf<T> chatter;
};

// e: the reaction at the displaced place over that on the reference slide, less 1.
template <class T>
AFM_INLINED T disturbance(const ReferenceForces<T>& f, const T& sigma, const T& p) {
  return (2.0 * f.turn * p - f.c_height * sigma) / f.P;
}

// The bounces keep v^3/P, so v = v_0 (1 + e/3), where v_0 is that on the reference slide.
template <class T>
AFM_INLINED T chatter_speed(const ChatterConstants& c, const T& x, const T& e) {
  return (c.constant_loss ? x : portable_exp(x)) * (1.0 + e * (1.0 / 3));
}

template <class T>
AFM_INLINED ChatterOf<T> to_chatter(const ChatterConstants& c, const ReferenceForces<T>& f,
                                    const ChatterVariables<T>& y) {
  return {chatter_speed(c, y.x, disturbance(f, y.sigma, y.p)), y.n, y.sigma, y.p, y.drift, y.loss};
}

// The law: the time derivatives.
template <class T>
AFM_INLINED ChatterVariables<T> chatter_rates(const ChatterConstants& c, const ReferenceForces<T>& f,
                                              const ChatterVariables<T>& y) {
  const T e = disturbance(f, y.sigma, y.p), v = chatter_speed(c, y.x, e), half_P = 0.5 * f.P * (1.0 + e);
  const T per_3P = 1.0 / (3.0 * f.P), squeeze = f.P1 * per_3P;
  const T per_P = 3.0 * per_3P, p1 = f.P1 * per_P, p2 = f.P2 * per_P;
  const T d = (3.0 * p2 - 4.0 * p1 * p1 - 9.0 * f.K) * (per_P * per_P) * (1.0 / 27);
  const auto [w, R, G, M, C] = loss_coefficients(c, v);
  const T rho = C * v * v * per_3P;
  return {c.constant_loss ? G * v * squeeze - half_P * (w * R) : G * squeeze - half_P * (c.w_per_v * R),
          M * half_P / v * (1.0 - v * (d * v + (c.constant_loss ? 0.0 : 1.0 / 9) * w * p1 * per_P)),
          y.p + 2.0 * f.turn * rho,
          f.c_height * rho - f.c_sigma * y.sigma,
          f.x_per_sigma * y.sigma + f.x_per_rho * rho,
          v * (half_P * (w * R) + v * squeeze * (C - G))};
}

// Duration of a bounce [tau].
template <class T>
AFM_INLINED T bounce_duration(const ChatterPoint<T>& at) {
  return 1.0 / at.rates.n;
}

// The adiabaticity ratio over its limit within a sequence.
template <class T>
AFM_INLINED double part_of_limit(const ChatterConstants& c, const ChatterPoint<T>& at) {
  const double limit = ChatterLimits::kMaxBounceWithin * c.fineness;
  const double P = static_cast<double>(at.forces.P);
  if (!(P > 0.0)) return std::numeric_limits<double>::infinity();
  return 2.0 * static_cast<double>(at.chatter.v) / P * at.forces.fastest / limit;
}

// The integration along one reference slide.
template <class T>
class ChatterIntegration {
 public:
  using Point = ChatterPoint<T>;
  using Run = ChatterRunOf<T>;

  AFM_INLINED ChatterIntegration(const ChatterConstants& constants, const SlideSegment<T>& reference)
      : c_(constants), reference_(reference) {}

  AFM_INLINED Point begin(const T& s, const ChatterOf<T>& start) const {
    const ReferenceForces<T> f = forces_at(s);
    const T v = start.v * (1.0 - disturbance(f, start.sigma, start.p) * (1.0 / 3));
    const T x = c_.constant_loss ? v : portable_log(v);
    Point at{s, f, {x, start.n, start.sigma, start.p, start.drift, start.loss}, {}, start};
    at.rates = chatter_rates(c_, at.forces, at.y);
    return at;
  }

  // From `begin` to `until`, or to the end of the sequence. Without `exits`, for a state in the middle of a known
  // sequence, the adiabaticity ratio is not checked.
  AFM_INLINED Run follow(const T& begin_s, double until, const ChatterOf<T>& start, bool exits) const {
    Point now = begin(begin_s, start);
    while (value(now.s) < until && value(now.chatter.v) > c_.threshold) {
      const double first = part_of_limit(c_, now);
      if (exits && !(first <= 1.0)) return exit_at(now, whole_after(now));
      double dt = step_length(now, until - value(now.s));
      Point next;
      for (;; dt *= 0.5) {
        if (!(value(now.s) + dt > value(now.s))) return {ChatterEnd::exits, now.s, now.chatter};
        next = step(now, dt);
        if (fits(now, dt, next)) break;
      }
      if (exits && !(part_of_limit(c_, next) <= 1.0)) return exit_at(now, last_whole(now, first, next, dt));
      now = next;
    }
    return {value(now.chatter.v) <= c_.threshold ? ChatterEnd::died : ChatterEnd::time, now.s, now.chatter};
  }

  // The state of the bounce with which n becomes N, near `from`. Neighbouring starts end with the same bounce, not at
  // the same time. Where the reaction vanishes before: `from` itself.
  AFM_INLINED Run exit_at(const Point& from, double N) const {
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
  using Forces = std::array<ReferenceForces<T>, kNodeCount>;
  using Rates = std::array<ChatterVariables<T>, kNodeCount>;

  AFM_INLINED static double value(const T& x) { return static_cast<double>(x); }
  AFM_INLINED static double whole_after(const Point& at) { return std::floor(value(at.y.n)) + 1.0; }

  // The last whole n of a step before the adiabaticity ratio reaches its limit, or the first whole n of the step. Near
  // the zero of the reaction the ratio grows like 1/(t_end - t)^2, so its inverse root is linear in time.
  AFM_INLINED double last_whole(const Point& from, double first, Point to, double dt) const {
    constexpr int kMaxTries = 4;  // one is enough but where P passes its maximum
    for (int i = 0; i < kMaxTries; ++i) {
      const double last = part_of_limit(c_, to);
      if (last <= ChatterLimits::kAccepted) return std::max(whole_after(from), std::floor(value(to.y.n)));
      const double left = 1.0 / std::sqrt(first) - 1.0, over = 1.0 - 1.0 / std::sqrt(last);
      dt *= left / (left + over);
      to = step(from, dt);
    }
    return whole_after(from);
  }

  AFM_INLINED ReferenceForces<T> forces_at(const T& s) const {
    return reference_forces(reference_.mechanics(), reference_.eta(), reference_.at(s));
  }

  AFM_INLINED double step_length(const Point& at, double rest) const {
    const double half_P = 0.5 * value(at.forces.P), v = value(at.chatter.v), x1 = value(at.rates.x);
    const double falls = c_.constant_loss ? ChatterLimits::kStep * v / (half_P * c_.w)
                                          : ChatterLimits::kFall / (half_P * c_.w_per_v);
    double dt = c_.fineness * std::min(falls, ChatterLimits::kStep / at.forces.change);
    // not far beyond the threshold, so that n counts the bounces down to it
    if (x1 < 0.0) dt = std::min(dt, (c_.end_x - value(at.y.x)) / x1);
    return rest <= dt ? rest : rest < 2.0 * dt ? 0.5 * rest : dt;  // the last two have one length
  }

  // The length of a step comes from the rates at its start. At rest on a crest they do not show the motion of a holder
  // that has just started.
  AFM_INLINED bool fits(const Point& from, double dt, const Point& next) const {
    // with a constant loss n goes like ln v, which has its pole at v = 0
    const double least_v = c_.constant_loss ? 0.5 * (1.0 - ChatterLimits::kStep) * value(from.chatter.v) : 0.0;
    return value(next.forces.P) > 0.0 && dt * next.forces.change <= ChatterLimits::kMaxChange &&
           value(next.chatter.v) > least_v;
  }

  // Over so short a time that the rates are constant.
  AFM_INLINED ChatterVariables<T> along(const Point& from, const T& dt) const {
    const ChatterVariables<T>&y = from.y, &r = from.rates;
    return {y.x + dt * r.x, y.n + dt * r.n,         y.sigma + dt * r.sigma,
            y.p + dt * r.p, y.drift + dt * r.drift, y.loss + dt * r.loss};
  }

  // The integral of the rates from the start of the step to node i.
  AFM_INLINED ChatterVariables<T> integral(const Point& from, double dt, const Rates& rates, std::size_t i) const {
    const auto sum = [&](T ChatterVariables<T>::*of) {
      T mean = kLobatto[0][i] * (from.rates.*of);
#pragma GCC unroll 4
      for (std::size_t k = 0; k < kNodeCount; ++k) mean = mean + kLobatto[k + 1][i] * (rates[k].*of);
      return from.y.*of + dt * mean;
    };
    using V = ChatterVariables<T>;
    return {sum(&V::x), sum(&V::n), sum(&V::sigma), sum(&V::p), sum(&V::drift), sum(&V::loss)};
  }

  // One step of Lobatto's method. Its equations are solved by iteration, from the first rates extrapolated.
  AFM_INLINED Point step(const Point& from, double dt) const {
    constexpr int kIterations = 2;
    Forces forces;
    Rates rates;
    // the nodes do not wait for each other: unrolled, their chains of operations overlap
#pragma GCC unroll 4
    for (std::size_t i = 0; i < kNodeCount; ++i) {
      forces[i] = forces_at(from.s + kNodes[i] * dt);
      rates[i] = chatter_rates(c_, forces[i], along(from, T(kNodes[i] * dt)));
    }
    for (int iteration = 0; iteration < kIterations; ++iteration) {
      const Rates before = rates;
#pragma GCC unroll 4
      for (std::size_t i = 0; i < kNodeCount; ++i) {
        rates[i] = chatter_rates(c_, forces[i], integral(from, dt, before, i));
      }
    }
    const ChatterVariables<T> y = integral(from, dt, rates, kNodeCount - 1);
    return {from.s + dt, forces.back(), y, rates.back(), to_chatter(c_, forces.back(), y)};
  }

  const ChatterConstants& c_;
  const SlideSegment<T>& reference_;
};

}  // namespace afm
