// The course of a chatter sequence: when it may begin, its steps, and their control.
#include "afm/chatter.h"

#include <algorithm>
#include <cmath>
#include <new>
#include <utility>

#include "chatter_control.h"
#include "chatter_geometry.h"
#include "projection.h"

namespace afm {
namespace {

using Control = ChatterControl;

// A step that was too long. Its length came from the rates at its start, and beyond a maximum the reaction falls
// faster. At rest on a crest they do not show the motion of a holder that has just started.
bool goes_too_far(const ChatterPoint& from, const ChatterPoint& to) {
  const double P = to.surroundings.P, rate = to.surroundings.relative_rate;
  return !(P > Control::kMinReaction * from.surroundings.P) || (to.s - from.s) * rate > Control::kMaxChange ||
         2.0 * from.chatter.v * rate > Control::kMaxBounce * P ||
         !(to.chatter.v < Control::kMaxSpeedGain * from.chatter.v) ||
         !(from.smooth.x - to.smooth.x < Control::kMaxFallOfLogV) || !std::isfinite(to.chatter.n);
}

}  // namespace

ChatterLaw::ChatterLaw(const Model& model, double threshold)
    : v_c_(model.v_c),
      threshold_(threshold),
      max_loss_(1.0 - model.gamma),
      rates_(model, !(model.v_c > threshold)),
      end_x_(rates_.x_of(std::max(v_c_ > threshold ? Control::kEndSpeed * threshold : threshold, 1e-300))),
      // the error of a step is of the fourth order in its length
      fineness_(std::sqrt(std::sqrt(std::min(1.0, threshold / Control::kUsualThreshold)))) {}

bool ChatterLaw::loses_too_much(double v) const {
  return v_c_ > threshold_ && (v > v_c_ || rates_.loss(v) > Control::kMaxLoss);
}

bool ChatterLaw::takes_single_bounces(double v) const {
  return max_loss_ >= Control::kMinSingleLoss && loses_too_much(v);
}

// The adiabaticity ratio: the duration of a bounce over the limit for it. The averages leave out terms of the third and
// fourth order of the duration against every change. The limit is wider `within` a sequence than at its start.
double ChatterLaw::adiabaticity(const ChatterSurroundings& at, double v, bool within) const {
  const double longer = within ? Control::kLongerWithin : 1.0;
  return 2.0 * v * at.inverse_P * std::max(at.relative_rate, at.slow_rate) /
         (Control::kMaxDuration * fineness_ * longer);
}

bool ChatterLaw::holds(const Flight<double>& bounce) const {
  const double v = bounce.start().g1;
  if (v <= threshold_) return true;
  if (!(bounce.start().g2 < 0.0)) return false;
  if (loses_too_much(v) && !takes_single_bounces(v)) return false;
  // most bounces are refused here, by the faster test
  if (rates_.geometry().certainly_outlasts(bounce, Control::kMaxDuration * fineness_)) return false;
  const double limit = loses_too_much(v) ? Control::kSingleRatio : 1.0;
  return adiabaticity(rates_.geometry().surroundings(bounce), v, false) <= limit;
}

double ChatterLaw::step_length(const ChatterPoint& at) const {
  const double v = at.chatter.v, relative_rate = at.surroundings.relative_rate;
  // The error of a step is that of a reaction which swings with the horizontal spring, and at twice its rate. The
  // smaller the swing, the longer the step.
  const double fastest = std::max(relative_rate, 2.0 * kTwoPi * at.surroundings.slow_rate);
  const double swing = std::sqrt(fastest * std::sqrt(relative_rate * fastest));
  // with a cutoff, ln v falls the more evenly the less a bounce loses
  const double falls = v_c_ > threshold_ ? Control::kFall / (0.5 + 2.5 * std::min(Control::kMaxLoss, rates_.loss(v)))
                                         : Control::kLinearFall;
  const double escape = time_to_fall(at.surroundings, Control::kLoseReaction);
  const double dt = fineness_ * std::min(std::min(falls * rates_.fall_time(at.surroundings, v), escape),
                                         std::min(Control::kChange / relative_rate, Control::kSwing / swing));
  return at.rate.x < 0.0 ? step_towards_end(at, dt) : dt;
}

// Not far beyond the threshold, so that n counts the bounces down to it. With a cutoff the losses go with the reaction,
// so x falls like x' (t + P'/P t^2 / 2).
double ChatterLaw::step_towards_end(const ChatterPoint& at, double dt) const {
  const double linear = (end_x_ - at.smooth.x) / at.rate.x;
  if (!(v_c_ > threshold_)) return std::min(dt, Control::kLinearEnd * linear);
  const double end = 2.0 * linear / (1.0 + std::sqrt(std::max(0.0, 1.0 + 6.0 * at.surroundings.c_speed * linear)));
  return end < Control::kLastStep * dt ? end : end < 2.0 * dt ? 0.5 * end : dt;
}

// A sequence that may exit goes back from a step at whose end the law no longer holds. Without `exits`, for the state
// in the middle of a known sequence, the law is not checked.
ChatterRun ChatterLaw::follow(const SlideSegment<double>& reference, double from, double until, const Chatter& start,
                              bool exits) const {
  ChatterRun first{ChatterEnd::time, from, start};
  if (takes_single_bounces(start.v)) first = follow_single_bounces(reference, from, until, start, exits);
  if (first.end != ChatterEnd::time || takes_single_bounces(first.chatter.v)) return first;
  // built in place, in turns: a copy of a point that has just been written would wait for memory
  ChatterPoint points[2] = {rates_.begin(reference, first.s, first.chatter), {}};
  ChatterPoint *now = &points[0], *next = &points[1];
  double until_limit = until;
  while (now->s < until && now->chatter.v > threshold_) {
    const double rest = until - now->s, longest = step_length(*now);
    const bool reaction_vanishes = -3.0 * now->surroundings.c_speed * rest > Control::kLoseReaction;
    // the last two steps have one length, unless the reaction vanishes before the end
    double dt = rest <= longest ? rest : rest < 2.0 * longest && !reaction_vanishes ? 0.5 * rest : longest;
    // the last bounce outlasts the reaction: the sequence ends here
    if (!(now->s + dt > now->s) || 2.0 * now->chatter.v * now->surroundings.relative_rate > now->surroundings.P)
      return {ChatterEnd::exits, now->s, now->chatter};
    dt = std::min(dt, until_limit);
    new (next) ChatterPoint(rates_.step(reference, *now, dt));
    while (goes_too_far(*now, *next)) {
      dt *= 0.5;
      if (!(now->s + dt > now->s)) return {ChatterEnd::exits, now->s, now->chatter};
      new (next) ChatterPoint(rates_.step(reference, *now, dt));
    }
    until_limit = until;
    if (exits && next->chatter.n >= std::floor(now->chatter.n) + 1.0) {
      const double ratio = adiabaticity(next->surroundings, next->chatter.v, true);
      if (ratio <= 1.0) until_limit = time_until_limit(*next, ratio);
      if (ratio > 1.0 || until_limit < Control::kFewBounces * duration(*next))
        return whole_bounce(reference, *now, *next, ratio);
    }
    std::swap(now, next);
  }
  return {now->chatter.v <= threshold_ ? ChatterEnd::died : ChatterEnd::time, now->s, now->chatter};
}

ChatterRun ChatterLaw::run(const SlideSegment<double>& reference, double from, double until,
                           const Chatter& start) const {
  return follow(reference, from, until, start, true);
}

Chatter ChatterLaw::at(const SlideSegment<double>& reference, double s, const Chatter& start) const {
  return follow(reference, 0.0, s, start, false).chatter;
}

Projection project_onto_surface(const Model& model, const TipState& state) {
  const auto p = projected<double>(is_free_along_x(model), model.H, {state.phase, state.X, state.u, state.g1});
  return {p.reference, p.normal_speed, p.tangential_velocity};
}

TipState leave_surface(const Model& model, const SlideState<double>& reference, double normal_speed) {
  const Bounce4<double> b = launched<double>(is_free_along_x(model), model.H, reference, normal_speed);
  return {wrap_phase(b.phase), b.X, b.u, 0.0, b.g1};
}

}  // namespace afm
