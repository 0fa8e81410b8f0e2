#include "afm/detail/chatter_rates.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "chatter_control.h"
#include "chatter_flow.h"
#include "chatter_geometry.h"
#include "collocation.h"
#include "portable_exp.h"
#include "projection.h"

namespace afm {
namespace {

// Of v in bounces that all lose the same part: first over mean, -log(gamma) / (1 - gamma).
double first_over_mean(double gamma) {
  constexpr double kAlmostElastic = 1e-8;  // 1 - gamma: below it the quotient is 1 to the last digit but one
  const double loss = 1.0 - gamma;
  if (loss < kAlmostElastic) return 1.0;
  return gamma > 0.0 ? -portable_log(gamma) / loss : std::numeric_limits<double>::infinity();
}

using AtNodes = std::array<SmoothChatter, kNodeCount>;

// The surroundings at node i from those at both ends, without the step control. The reaction is interpolated to the
// order 8, what stands only in terms of the second order linearly.
inline ChatterSurroundings between(const ChatterSurroundings& first, const ChatterSurroundings& last, double dt,
                                   std::size_t i) {
  const auto linear = [i](double a, double b) { return std::fma(kNodes[i], b, kRest[i] * a); };
  const HermitePoint P = hermite(dt, hermite_end(dt, first.P, first.P1, first.P2, first.P3),
                                 hermite_end(-dt, last.P, last.P1, last.P2, last.P3), i);
  ChatterSurroundings at;
  at.P = P.value, at.P1 = P.slope, at.P2 = P.bend;
  at.P3 = linear(first.P3, last.P3);
  at.K = linear(first.K, last.K), at.K1 = linear(first.K1, last.K1);
  set_reaction_terms(at);
  at.turn_rate = linear(first.turn_rate, last.turn_rate);
  at.c_height = linear(first.c_height, last.c_height), at.c_sigma = linear(first.c_sigma, last.c_sigma);
  at.x_per_sigma = linear(first.x_per_sigma, last.x_per_sigma);
  at.x_per_rho = linear(first.x_per_rho, last.x_per_rho);
  return at;
}

// start plus the integral of the rates from the start of the step to node i.
inline SmoothChatter integrated(double dt, const SmoothChatter& start, const SmoothChatter& first, const AtNodes& rates,
                                std::size_t i) {
  const auto sum = [&](double SmoothChatter::*of) {
    double x = std::fma(dt * kLobatto[0][i], first.*of, start.*of);
#pragma GCC unroll 4
    for (std::size_t k = 0; k < kNodeCount; ++k) x = std::fma(dt * kLobatto[k + 1][i], rates[k].*of, x);
    return x;
  };
  return {sum(&SmoothChatter::x), sum(&SmoothChatter::rest),  sum(&SmoothChatter::sigma),
          sum(&SmoothChatter::p), sum(&SmoothChatter::drift), sum(&SmoothChatter::held_work)};
}

// On entry to.smooth and to.rate are those at the start of the step, and to.surroundings those at its end. The
// equations of the method are solved by iteration, from the first rate extrapolated. Three iterations leave an error of
// 1e-7 of what the step changes where w is 0.1.
inline void collocation_step(const ChatterFlow& flow, const ChatterPoint& from, double dt, ChatterPoint& to) {
  const SmoothChatter start = to.smooth, first = to.rate;
  std::array<ChatterSurroundings, kNodeCount> at;
  AtNodes rates;
  // the nodes do not wait for each other: unrolled, their chains of operations overlap
#pragma GCC unroll 4
  for (std::size_t i = 0; i < kNodeCount; ++i) {
    at[i] = between(from.surroundings, to.surroundings, dt, i);
    rates[i] = chatter_rate(flow, at[i], to.n_per_inverse_v, start + kNodes[i] * dt * first);
  }
  constexpr int kIterations = 2;  // after the extrapolation
  for (int iteration = 0; iteration < kIterations; ++iteration) {
    const AtNodes before = rates;
#pragma GCC unroll 4
    for (std::size_t i = 0; i < kNodeCount; ++i) {
      rates[i] = chatter_rate(flow, at[i], to.n_per_inverse_v, integrated(dt, start, first, before, i));
    }
  }
  to.smooth = integrated(dt, start, first, rates, kNodeCount - 1);
  to.rate = rates.back();
}

}  // namespace

ChatterGeometry::ChatterGeometry(const Model& model)
    : H_(model.H),
      wv2_(square(kTwoPi)),
      free_(is_free_along_x(model)),
      wh2_(free_ * square(kTwoPi * model.frequency_ratio)),
      slow_rate_(std::max(1.0, free_ * model.frequency_ratio)) {}

ChatterRates::ChatterRates(const Model& model, bool geometric)
    : geometry_(model), flow_{geometric,   geometry_.is_held_along_x(),
                              model.gamma, geometric ? 0.0 : (1.0 - model.gamma) / model.v_c,
                              0.0,         1.0 / first_over_mean(model.gamma)} {
  const double loss = geometric ? 1.0 - model.gamma : flow_.loss;
  const bool falls = loss > ChatterControl::kMinLoss;
  flow_.n_per_inverse_v = falls ? (geometric ? flow_.inverse_mean : 1.0) / loss : 0.0;
}

double ChatterRates::x_of(double v) const { return smooth_speed(flow_, v); }

double ChatterRates::fall_time(const ChatterSurroundings& at, double v) const {
  return 2.0 * at.inverse_P * (flow_.geometric ? v / (1.0 - flow_.gamma) : 1.0 / flow_.loss);
}

ChatterPoint ChatterRates::begin(const SlideSegment<double>& reference, double s, const Chatter& start) const {
  ChatterPoint at{s, geometry_.surroundings(reference, s), {}, {}, start, flow_.n_per_inverse_v};
  at.smooth = to_smooth(flow_, at.surroundings, at.n_per_inverse_v, start);
  at.rate = chatter_rate(flow_, at.surroundings, at.n_per_inverse_v, at.smooth);
  return at;
}

ChatterPoint ChatterRates::step(const SlideSegment<double>& reference, const ChatterPoint& from, double dt) const {
  // a lambda, as a function that returns one of two variables would copy the point
  const auto by_collocation = [&] {
    const bool falls_fast = dt > ChatterControl::kFastFall * fall_time(from.surroundings, from.chatter.v);
    const double n_per_inverse_v = falls_fast ? flow_.n_per_inverse_v : 0.0,
                 more = n_per_inverse_v - from.n_per_inverse_v;
    ChatterPoint to{from.s + dt,    geometry_.surroundings(reference, from.s + dt), from.smooth, from.rate, {},
                    n_per_inverse_v};
    if (!flow_.geometric && more != 0.0) {
      const double bounces = more / chatter_speed(flow_, from.smooth.x);
      to.smooth.rest -= bounces, to.rate.rest += bounces * from.rate.x;
    }
    collocation_step(flow_, from, dt, to);
    to.chatter = from_smooth(flow_, to.surroundings, to.n_per_inverse_v, to.smooth);
    return to;
  };
  const double fastest = std::max(from.surroundings.relative_rate, from.surroundings.slow_rate);
  return dt * fastest < ChatterControl::kBriefStep ? brief_step(reference, from, dt) : by_collocation();
}

ChatterPoint ChatterRates::brief_step(const SlideSegment<double>& reference, const ChatterPoint& from,
                                      double dt) const {
  ChatterPoint to{from.s + dt, geometry_.surroundings(reference, from.s + dt), {}, {}, {}, from.n_per_inverse_v};
  to.rate = chatter_rate(flow_, to.surroundings, to.n_per_inverse_v, from.smooth + dt * from.rate);
  to.smooth = from.smooth + 0.5 * dt * (from.rate + to.rate);
  to.chatter = from_smooth(flow_, to.surroundings, to.n_per_inverse_v, to.smooth);
  return to;
}

Chatter ChatterRates::after(const ChatterPoint& from, double dt) const {
  return from_smooth(flow_, from.surroundings, from.n_per_inverse_v, from.smooth + dt * from.rate);
}

SlideState<double> moved_reference(const Model& model, const SlideState<double>& reference, const Chatter& chatter) {
  return moved_reference_of(model.H, reference, chatter);
}

}  // namespace afm
