#include "afm/chatter.h"

#include <algorithm>
#include <cmath>
#include <new>
#include <utility>

#include "afm/detail/multiversion.h"
#include "projection.h"

namespace afm {
namespace {

// Step control of a chatter sequence. Where no formula stands, the value is measured: benchmark/burst_error, by which the
// errors of sequences stay within the contact tolerance. [1] unless a unit is given.
struct Limit {
  // When a sequence may begin and go on.
  static constexpr double kLoss = 0.25;         // of v in a bounce: the series of chatter_flow.h are good to 5e-4
  static constexpr double kShortness = 0.06;    // duration of a bounce over the time in which the reaction changes
  static constexpr double kLongerWithin = 2.5;  // times that within a sequence, as only its last bounces matter
  static constexpr double kSteepRatio = 0.5;    // times that for bounces one by one, which see the reaction as a cubic
  // A step, as a part of the time in which ...
  static constexpr double kFall = 2.0;          // ... v falls, with a cutoff
  static constexpr double kEvenFall = 0.7;      // ... v falls to zero, without a cutoff
  static constexpr double kChange = 0.9;        // ... the reaction changes
  static constexpr double kSwing = 2.4;         // ... the reaction swings with the horizontal spring
  static constexpr double kLoseReaction = 0.6;  // of the reaction that a step may lose by its first two derivatives
  // What must hold at the end of a step, or it is halved.
  static constexpr double kLeastReaction = 0.33;  // over that at its beginning
  static constexpr double kChanged = 1.6;         // step over the time in which the reaction changes at its end
  static constexpr double kRise = 2.0;            // v over that at its beginning
  static constexpr double kOutlasting = 4.0;      // bounce over the time in which the reaction changes
  static constexpr double kFallOfLogV = 10.0;     // of ln v; far more than any step is to take
  // The last step may end below the threshold, and be longer.
  static constexpr double kEnd = 0.9;    // v there over the threshold
  static constexpr double kLast = 1.25;  // over a usual step
};

// A step that was too long. Its length came from rates at its beginning: beyond a maximum the reaction falls faster than
// they say, and at rest on a crest they do not show a holder that has just been made fast.
bool goes_too_far(const ChatterPlace& from, const ChatterPlace& to) {
  const double P = to.around.P;
  return !(P > Limit::kLeastReaction * from.around.P) || (to.s - from.s) * to.around.relative_rate > Limit::kChanged ||
         2.0 * from.plain.v * to.around.relative_rate > Limit::kOutlasting * P ||
         !(to.plain.v < Limit::kRise * from.plain.v) || !(from.even.x - to.even.x < Limit::kFallOfLogV) ||
         !std::isfinite(to.plain.n);
}

}  // namespace

ChatterLaw::ChatterLaw(const Model& model, double threshold)
    : v_c_(model.v_c),
      threshold_(threshold),
      most_loss_(1.0 - model.gamma),
      rates_(model, !(model.v_c > threshold)),
      end_x_(rates_.x_of(std::max(v_c_ > threshold ? Limit::kEnd * threshold : threshold, 1e-300))) {
  constexpr double kUsualThreshold = 1e-5;
  fineness_ = std::sqrt(std::sqrt(std::min(1.0, threshold / kUsualThreshold)));
}

// For the averages.
bool ChatterLaw::loses_too_much(double v) const { return v_c_ > threshold_ && (v > v_c_ || rates_.loss(v) > Limit::kLoss); }

// The adiabaticity ratio: how long a bounce lasts over how long it may last (1: the limit). The averages leave out terms of
// the third and fourth order of the bounce's duration against all changes. `within` a sequence, or at its entry.
double ChatterLaw::adiabaticity(const ChatterSurroundings& at, double v, bool within) const {
  const double longer = within ? Limit::kLongerWithin : 1.0;
  return 2.0 * v * at.inverse_P * std::max(at.relative_rate, at.slow_rate) / (Limit::kShortness * fineness_ * longer);
}

AFM_MULTIVERSION bool ChatterLaw::holds(const Flight<double>& bounce) const {
  const double v = bounce.start().g1;
  if (v <= threshold_) return true;
  if (!(bounce.start().g2 < 0.0)) return false;
  if (loses_too_much(v) && !takes_single_bounces(v)) return false;
  // most that are asked for are refused
  if (rates_.certainly_outlasts(bounce, Limit::kShortness * fineness_)) return false;
  return adiabaticity(rates_.surroundings(bounce), v, false) <= (loses_too_much(v) ? Limit::kSteepRatio : 1.0);
}

// Parts of the times in which v and P change by themselves. Smaller thresholds take smaller steps.
double ChatterLaw::step_length(const ChatterPlace& at) const {
  const double v = at.plain.v, relative_rate = at.around.relative_rate;
  // the error of a step is that of a pressure which swings with the horizontal spring and at twice its rate: the less
  // it changes by, the longer
  const double fastest = std::max(relative_rate, 2.0 * kTwoPi * at.around.slow_rate);
  const double swing = std::sqrt(fastest * std::sqrt(relative_rate * fastest));
  // with a cutoff, the less a bounce loses the more evenly ln v falls
  const double falls =
      v_c_ > threshold_ ? Limit::kFall / (0.5 + 2.5 * std::min(Limit::kLoss, rates_.loss(v))) : Limit::kEvenFall;
  const double escape = time_to_fall(at.around, Limit::kLoseReaction);
  const double dt = fineness_ * std::min(std::min(falls * rates_.fall_time(at.around, v), escape),
                                         std::min(Limit::kChange / relative_rate, Limit::kSwing / swing));
  return at.rate.x < 0.0 ? step_towards_end(at, dt) : dt;
}

// And not far beyond the threshold, so that n counts the bounces down to it: by x, and as the losses go with the
// pressure, x + x' (t + P'/P t^2 / 2); without a cutoff v falls too far in a thousandth of the way.
double ChatterLaw::step_towards_end(const ChatterPlace& at, double dt) const {
  const double even = (end_x_ - at.even.x) / at.rate.x;
  if (!(v_c_ > threshold_)) return std::min(dt, 1.02 * even);
  const double end = 2.0 * even / (1.0 + std::sqrt(std::max(0.0, 1.0 + 6.0 * at.around.c_speed * even)));
  return end < Limit::kLast * dt ? end : end < 2.0 * dt ? 0.5 * end : dt;
}

// A step that ends where the interpolation no longer holds is gone back from. Without exits, for the state in the
// middle of a burst, it is not asked.
AFM_MULTIVERSION ChatterRun ChatterLaw::follow(const SlideSegment<double>& reference, double from, double until,
                                               const Chatter& start, bool exits) const {
  constexpr double kFewBounces = 2.0;  // are not worth a step
  ChatterRun first{ChatterEnd::time, from, start};
  if (takes_single_bounces(start.v)) first = follow_single_bounces(reference, from, until, start, exits);
  if (first.end != ChatterEnd::time || takes_single_bounces(first.chatter.v)) return first;
  // made in place, in turn: a copy of what has just been written would wait until it is in memory
  ChatterPlace places[2] = {rates_.begin(reference, first.s, first.chatter), {}};
  ChatterPlace *now = &places[0], *next = &places[1];
  double until_limit = until;
  while (now->s < until && now->plain.v > threshold_) {
    const double rest = until - now->s, longest = step_length(*now);
    const bool lets_go = -3.0 * now->around.c_speed * rest > Limit::kLoseReaction;
    // the last two alike, but where there is nothing left at the end
    double dt = rest <= longest ? rest : rest < 2.0 * longest && !lets_go ? 0.5 * rest : longest;
    // the last bounce of all lasts beyond the pressure: it is left where it is
    if (!(now->s + dt > now->s) || 2.0 * now->plain.v * now->around.relative_rate > now->around.P)
      return {ChatterEnd::exits, now->s, now->plain};
    dt = std::min(dt, until_limit);
    new (next) ChatterPlace(rates_.step(reference, *now, dt));
    while (goes_too_far(*now, *next)) {
      dt *= 0.5;
      if (!(now->s + dt > now->s)) return {ChatterEnd::exits, now->s, now->plain};
      new (next) ChatterPlace(rates_.step(reference, *now, dt));
    }
    until_limit = until;
    if (exits && next->plain.n >= std::floor(now->plain.n) + 1.0) {
      const double ratio = adiabaticity(next->around, next->plain.v, true);
      if (ratio <= 1.0) until_limit = time_until_limit(*next, ratio);
      if (ratio > 1.0 || until_limit < kFewBounces * duration(*next)) return whole_bounce(reference, *now, *next, ratio);
    }
    std::swap(now, next);
  }
  return {now->plain.v <= threshold_ ? ChatterEnd::died : ChatterEnd::time, now->s, now->plain};
}

ChatterRun ChatterLaw::run(const SlideSegment<double>& reference, double from, double until, const Chatter& start) const {
  return follow(reference, from, until, start, true);
}

Chatter ChatterLaw::at(const SlideSegment<double>& reference, double s, const Chatter& start) const {
  return follow(reference, 0.0, s, start, false).chatter;
}

AFM_MULTIVERSION Projection project_onto_surface(const Model& model, const TipState& state) {
  const auto p = projected<double>(is_free_along_x(model), model.H, {state.phase, state.X, state.u, state.g1});
  return {p.reference, p.normal_speed, p.tangential_velocity};
}

AFM_MULTIVERSION TipState leave_surface(const Model& model, const SlideState<double>& reference, double normal_speed) {
  const Bounce4<double> b = launched<double>(is_free_along_x(model), model.H, reference, normal_speed);
  return {wrap_phase(b.phase), b.X, b.u, 0.0, b.g1};
}

}  // namespace afm
