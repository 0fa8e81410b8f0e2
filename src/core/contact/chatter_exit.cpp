// How a sequence ends if its bounces become too long for the law: at the last whole bounce before the limit.
#include <algorithm>
#include <cmath>
#include <limits>

#include "afm/chatter.h"
#include "chatter_control.h"

namespace afm {
namespace {

using Control = ChatterControl;

double square(double x) { return x * x; }

// The time since `from` at which n is reached: a cubic through both ends, whose slopes are the durations of the bounces
// there.
double time_at(double n, const ChatterPoint& from, const ChatterPoint& to) {
  const double bounces = to.chatter.n - from.chatter.n, x = (n - from.chatter.n) / bounces, rest = 1.0 - x;
  return (to.s - from.s) * x * x * (3.0 - 2.0 * x) + bounces * x * rest * (duration(from) * rest - duration(to) * x);
}

// What adiabaticity() uses, extrapolated by dt with the first two derivatives of the reaction.
ChatterSurroundings extrapolated(const ChatterSurroundings& now, double dt) {
  ChatterSurroundings at = now;
  at.P = now.P + dt * (now.P1 + 0.5 * dt * now.P2), at.inverse_P = 1.0 / at.P;
  at.c_speed = (now.P1 + dt * now.P2) * at.inverse_P / 3.0;
  at.relative_rate = std::sqrt(std::max(9.0 * square(at.c_speed), std::abs(now.P2 * at.inverse_P)));
  return at;
}

// The part of a step until the adiabaticity ratio is 1. We use that it grows like 1/(t_end - t)^2 near the zero of the
// reaction, so its inverse root is linear in time.
double part_until_limit(double first_ratio, double last_ratio) {
  const double first = 1.0 / std::sqrt(std::max(first_ratio, Control::kMinRatio)), last = 1.0 / std::sqrt(last_ratio);
  return first > 1.0 ? (first - 1.0) / (first - last) : 0.0;
}

}  // namespace

// An estimate of the time until the adiabaticity ratio is 1; zero or less if it is 1 already. Near the zero of the
// reaction the ratio grows like 1/(t_end - t)^2. Far from it the growth is slower, so a second estimate starts from the
// first.
double ChatterLaw::time_until_limit(const ChatterPoint& at, double ratio) const {
  if (!(-3.0 * at.surroundings.c_speed * duration(at) > Control::kNearEnd))
    return std::numeric_limits<double>::infinity();
  const double time_to_zero = time_to_fall(at.surroundings, 1.0), estimate = time_to_zero * (1.0 - std::sqrt(ratio));
  if (!(estimate > 0.0 && estimate < time_to_zero)) return estimate;
  const double fall = std::max(0.0, -at.rate.x * (v_c_ > threshold_ ? 1.0 : 1.0 / at.chatter.v));
  const double then =
      adiabaticity(extrapolated(at.surroundings, estimate), at.chatter.v / (1.0 + fall * estimate), true);
  return estimate + (time_to_zero - estimate) * (1.0 - std::sqrt(then));
}

// Ends the sequence at a whole n that is so near that the rates are constant until then.
ChatterRun ChatterLaw::exit_at(double n, const ChatterPoint& at) const {
  const double rest = (n - at.chatter.n) * duration(at);
  const Chatter c = rates_.after(at, rest);
  return {ChatterEnd::exits, at.s + rest, {c.v, n, c.sigma, c.p, c.drift, c.held_work}};
}

// The last whole n of a step before the limit, or the first whole n of the step. n only grows, so it is bracketed.
ChatterRun ChatterLaw::whole_bounce(const SlideSegment<double>& reference, const ChatterPoint& from,
                                    const ChatterPoint& to, double last_ratio) const {
  const double first_n = std::floor(from.chatter.n) + 1.0, dt = to.s - from.s;
  const double least = std::min(dt, (first_n - from.chatter.n) * duration(from));
  const double first_ratio = adiabaticity(from.surroundings, from.chatter.v, true);
  ChatterPoint at = to;
  for (int i = 0; i < Control::kMaxTries && last_ratio > Control::kAcceptedRatio && at.s - from.s > least; ++i) {
    at = rates_.step(reference, from, std::max(least, part_until_limit(first_ratio, last_ratio) * (at.s - from.s)));
    last_ratio = adiabaticity(at.surroundings, at.chatter.v, true);
  }
  // allowed error of n: a part of a bounce, and of what is left to the whole one
  const auto nearly = [&](double n) {
    return Control::kNearlyWhole * std::clamp(n - from.chatter.n, Control::kMinRest, 1.0);
  };
  // by one brief step, if the nearest whole n is less than half a bounce away
  const double nearest = std::max(first_n, std::floor(at.chatter.n + 0.5)), half = nearest - at.chatter.n;
  if (std::abs(half) <= 0.5 && duration(at) < Control::kLittleLoss * rates_.fall_time(at.surroundings, at.chatter.v)) {
    const ChatterPoint beside = rates_.brief_step(reference, at, half * duration(at));
    if (std::abs(nearest - beside.chatter.n) <= nearly(nearest)) return exit_at(nearest, beside);
  }
  const double n = std::max(first_n, std::floor(at.chatter.n));
  double low = 0.0, high = dt, next = time_at(n, from, at);
  for (int i = 0; i < Control::kMaxSteps && !(std::abs(n - at.chatter.n) <= nearly(n)); ++i) {
    const double now = at.s - from.s;
    (n > at.chatter.n ? low : high) = now;
    at = rates_.step(reference, from, next > low && next < high ? next : 0.5 * (low + high));
    next = at.s - from.s + (n - at.chatter.n) * duration(at);
  }
  ChatterRun run = exit_at(n, at);
  run.s = std::max(from.s, run.s);
  return run;
}

}  // namespace afm
