// How a burst ends where its bounces come to last too long for the averages: at the last whole bounce before.
#include <algorithm>
#include <cmath>
#include <limits>

#include "afm/chatter.h"

namespace afm {
namespace {

double square(double x) { return x * x; }

// When n is reached in a step between two ends: the cubic through both with the bounces' durations as its slopes.
double time_at(double n, const ChatterPlace& from, const ChatterPlace& to) {
  const double bounces = to.plain.n - from.plain.n, x = (n - from.plain.n) / bounces, rest = 1.0 - x;
  return (to.s - from.s) * x * x * (3.0 - 2.0 * x) + bounces * x * rest * (duration(from) * rest - duration(to) * x);
}

// What the strain of a bounce asks for, so much later.
ChatterSurroundings extrapolated(const ChatterSurroundings& now, double dt) {
  ChatterSurroundings at = now;
  at.P = now.P + dt * (now.P1 + 0.5 * dt * now.P2), at.inverse_P = 1.0 / at.P;
  at.c_speed = (now.P1 + dt * now.P2) * at.inverse_P / 3.0;
  at.relative_rate = std::sqrt(std::max(9.0 * square(at.c_speed), std::abs(now.P2 * at.inverse_P)));
  return at;
}

// The part of a step until its bounces last too long: where the pressure falls to nothing they do like its square,
// upside down.
double part_until_limit(double first_ratio, double last_ratio) {
  constexpr double kLeast = 1e-9;
  const double first = 1.0 / std::sqrt(std::max(first_ratio, kLeast)), last = 1.0 / std::sqrt(last_ratio);
  return first > 1.0 ? (first - 1.0) / (first - last) : 0.0;
}

}  // namespace

// How long until the bounces of a falling pressure last too long, about; 0 or less where they do already. Their strain
// grows like the square of the time to nothing, upside down, and where that is far off more slowly: it is foretold
// there.
double ChatterLaw::time_until_limit(const ChatterPlace& at, double ratio) const {
  constexpr double kFar = 0.009;  // no step goes as far as from there
  if (!(-3.0 * at.around.c_speed * duration(at) > kFar)) return std::numeric_limits<double>::infinity();
  const double time_to_zero = time_to_fall(at.around, 1.0), soon = time_to_zero * (1.0 - std::sqrt(ratio));
  if (!(soon > 0.0 && soon < time_to_zero)) return soon;
  const double fall = std::max(0.0, -at.rate.x * (v_c_ > threshold_ ? 1.0 : 1.0 / at.plain.v));
  const double then = adiabaticity(extrapolated(at.around, soon), at.plain.v / (1.0 + fall * soon), true);
  return soon + (time_to_zero - soon) * (1.0 - std::sqrt(then));
}

// At a whole n, next to nothing from where it is known: there it is gone to evenly.
ChatterRun ChatterLaw::exit_at(double n, const ChatterPlace& at) const {
  const double rest = (n - at.plain.n) * duration(at);
  const Chatter c = rates_.after(at, rest);
  return {ChatterEnd::exits, at.s + rest, {c.v, n, c.sigma, c.p, c.drift, c.lift}};
}

// The last whole n of a step before its bounces last too long, or its first: bracketed, as n only grows. Half a bounce
// either way is not worth a step.
ChatterRun ChatterLaw::whole_bounce(const SlideSegment<double>& reference, const ChatterPlace& from, const ChatterPlace& to,
                                    double last_ratio) const {
  constexpr double kAcceptedRatio = 1.05, kNearlyWhole = 1e-2, kLeastRest = 1e-6;
  constexpr double kLittleLoss = 0.03;  // of v in a bounce: over half of one the mean of two rates is enough
  constexpr int kMostTries = 5, kMostSteps = 40;
  const double first_n = std::floor(from.plain.n) + 1.0, dt = to.s - from.s;
  const double least = std::min(dt, (first_n - from.plain.n) * duration(from));
  const double first_ratio = adiabaticity(from.around, from.plain.v, true);
  ChatterPlace at = to;
  // more than once where the pressure passes its maximum
  for (int i = 0; i < kMostTries && last_ratio > kAcceptedRatio && at.s - from.s > least; ++i) {
    at = rates_.step(reference, from, std::max(least, part_until_limit(first_ratio, last_ratio) * (at.s - from.s)));
    last_ratio = adiabaticity(at.around, at.plain.v, true);
  }
  // of a bounce, and of what is left to the whole one
  const auto nearly = [&](double n) { return kNearlyWhole * std::clamp(n - from.plain.n, kLeastRest, 1.0); };
  const double nearest = std::max(first_n, std::floor(at.plain.n + 0.5)), half = nearest - at.plain.n;
  if (std::abs(half) <= 0.5 && duration(at) < kLittleLoss * rates_.fall_time(at.around, at.plain.v)) {
    const ChatterPlace beside = rates_.brief_step(reference, at, half * duration(at));
    if (std::abs(nearest - beside.plain.n) <= nearly(nearest)) return exit_at(nearest, beside);
  }
  const double n = std::max(first_n, std::floor(at.plain.n));
  double low = 0.0, high = dt, next = time_at(n, from, at);
  for (int i = 0; i < kMostSteps && !(std::abs(n - at.plain.n) <= nearly(n)); ++i) {
    const double now = at.s - from.s;
    (n > at.plain.n ? low : high) = now;
    at = rates_.step(reference, from, next > low && next < high ? next : 0.5 * (low + high));
    next = at.s - from.s + (n - at.plain.n) * duration(at);
  }
  ChatterRun run = exit_at(n, at);
  run.s = std::max(from.s, run.s);
  return run;
}

}  // namespace afm
