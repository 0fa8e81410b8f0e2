#include "afm/chatter.h"

#include <algorithm>
#include <cmath>
#include <new>
#include <utility>

#include "afm/detail/multiversion.h"
#include "projection.h"

namespace afm {
namespace {

// |w| up to which the series of chatter_flow.h are good to 5e-4
constexpr double kMostLoss = 0.25;
// The duration of a bounce against the time in which the pressure changes by itself, at most, where a burst begins.
// What the averages leave out there it carries along; at its end only the last bounces do, and they may last longer.
constexpr double kMostShortness = 0.06;
constexpr double kLongerWithin = 2.5;
// Bounces that are made one by one along the guide see the pressure as a cubic of the time.
constexpr double kMostSteepStrain = 0.5;
// A tip that rings over a crest, where none rides faster than about 1 a/tau, bounces thousands of times a tau for
// hundreds of tau, and more than three hundred of them last longer than that. What it costs to average them is a part
// of the normal speed: slower ones may last longer, from the first.
constexpr double kRinging = 1.5;         // [a/tau] at most
constexpr double kFullSpeed = 2e3;       // thresholds: bounces of a ringing tip slower than this may last longer
constexpr double kMostLongerSlow = 1.9;  // times at most

// A step, in parts of the times in which v falls (evenly to nothing: where there is no cutoff), the reaction changes,
// and it swings with the horizontal spring.
constexpr double kFallPerStep = 2.0, kEvenFallPerStep = 0.7, kChangePerStep = 0.9, kSwingPerStep = 2.4;
// The pressure is to lose no more than this part of itself in a step, and must not fall below that; v may rise to so
// many times itself; and where a step ends, it may be so many times as long as the pressure takes to change, and a
// bounce so many times as long as it lasts.
constexpr double kLossPerStep = 0.6, kMostFall = 0.33, kMostChange = 1.6, kMostRise = 2.0, kMostOutlasting = 4.0;
// A burst ends a little below the threshold; the step to there may be a little longer.
constexpr double kEnd = 0.9, kLast = 1.25;
constexpr double kMostFallOfX = 10.0;  // of ln v: far more than any step is to take

// Past a maximum the pressure may fall faster than its rate foretells; at rest on a crest nothing tells of a holder
// that has just been made fast.
bool goes_too_far(const ChatterPlace& from, const ChatterPlace& to) {
  const double P = to.around.P;
  return !(P > kMostFall * from.around.P) || (to.s - from.s) * to.around.quickness > kMostChange ||
         2.0 * from.plain.v * to.around.quickness > kMostOutlasting * P || !(to.plain.v < kMostRise * from.plain.v) ||
         !(from.even.x - to.even.x < kMostFallOfX) || !std::isfinite(to.plain.n);
}

}  // namespace

ChatterLaw::ChatterLaw(const Model& model, double threshold)
    : v_c_(model.v_c),
      threshold_(threshold),
      most_loss_(1.0 - model.gamma),
      rates_(model, !(model.v_c > threshold)),
      end_x_(rates_.x_of(std::max(v_c_ > threshold ? kEnd * threshold : threshold, 1e-300))) {
  constexpr double kUsualThreshold = 1e-5;
  fineness_ = std::sqrt(std::sqrt(std::min(1.0, threshold / kUsualThreshold)));
}

// For the averages.
bool ChatterLaw::steep(double v) const { return v_c_ > threshold_ && (v > v_c_ || rates_.loss(v) > kMostLoss); }

// How long a bounce lasts, over how long it may. What the averages leave out is of the third and fourth order of its
// duration against all changes. `within` a burst, or at the entry to one: there bounces of a falling pressure, which
// lengthen, may not last longer.
double ChatterLaw::strain(const ChatterSurroundings& at, double v, bool within) const {
  double longer = within ? kLongerWithin : 1.0;
  if (at.speed <= kRinging && (within || at.squeeze >= 0.0))
    longer = std::clamp(std::sqrt(kFullSpeed * threshold_ / v), 1.0, kMostLongerSlow);
  return 2.0 * v * at.per_P * std::max(at.quickness, at.slow_rate) / (kMostShortness * fineness_ * longer);
}

AFM_MULTIVERSION bool ChatterLaw::holds(const Flight<double>& bounce) const {
  const double v = bounce.start().g1;
  if (v <= threshold_) return true;
  if (!(bounce.start().g2 < 0.0)) return false;
  if (steep(v) && !descends(v)) return false;
  // most that are asked for are refused
  const double longest = std::abs(bounce.launch().u) <= kRinging ? kMostLongerSlow : 1.0;
  if (rates_.outlasts(bounce, kMostShortness * fineness_ * longest)) return false;
  return strain(rates_.surroundings(bounce), v, false) <= (steep(v) ? kMostSteepStrain : 1.0);
}

// Parts of the times in which v and P change by themselves. Smaller thresholds take smaller steps.
double ChatterLaw::step_length(const ChatterPlace& at) const {
  const double v = at.plain.v, quickness = at.around.quickness;
  // the error of a step is that of a pressure which swings with the horizontal spring and at twice its rate: the less
  // it changes by, the longer
  const double fastest = std::max(quickness, 2.0 * kTwoPi * at.around.slow_rate);
  const double swing = std::sqrt(fastest * std::sqrt(quickness * fastest));
  // with a cutoff, the less a bounce loses the more evenly ln v falls
  const double falls =
      v_c_ > threshold_ ? kFallPerStep / (0.5 + 2.5 * std::min(kMostLoss, rates_.loss(v))) : kEvenFallPerStep;
  const double escape = time_to_fall(at.around, kLossPerStep);
  const double dt = fineness_ * std::min(std::min(falls * rates_.fall_time(at.around, v), escape),
                                         std::min(kChangePerStep / quickness, kSwingPerStep / swing));
  return at.rate.x < 0.0 ? step_towards_end(at, dt) : dt;
}

// And not far beyond the threshold, so that n counts the bounces down to it: by x, and as the losses go with the
// pressure, x + x' (t + P'/P t^2 / 2); without a cutoff v falls too far in a thousandth of the way.
double ChatterLaw::step_towards_end(const ChatterPlace& at, double dt) const {
  const double even = (end_x_ - at.even.x) / at.rate.x;
  if (!(v_c_ > threshold_)) return std::min(dt, 1.02 * even);
  const double end = 2.0 * even / (1.0 + std::sqrt(std::max(0.0, 1.0 + 6.0 * at.around.squeeze * even)));
  return end < kLast * dt ? end : end < 2.0 * dt ? 0.5 * end : dt;
}

// A step that ends where the interpolation no longer holds is gone back from. Without exits, for the state in the
// middle of a burst, it is not asked.
AFM_MULTIVERSION ChatterRun ChatterLaw::follow(const SlidePiece<double>& guide, double from, double until,
                                               const Chatter& start, bool exits) const {
  constexpr double kFewBounces = 2.0;  // are not worth a step
  ChatterRun first{ChatterEnd::time, from, start};
  if (descends(start.v)) first = descend(guide, from, until, start, exits);
  if (first.end != ChatterEnd::time || descends(first.chatter.v)) return first;
  // made in place, in turn: a copy of what has just been written would wait until it is in memory
  ChatterPlace places[2] = {rates_.begin(guide, first.s, first.chatter), {}};
  ChatterPlace *now = &places[0], *next = &places[1];
  double bearable = until;
  while (now->s < until && now->plain.v > threshold_) {
    const double rest = until - now->s, longest = step_length(*now);
    const bool lets_go = -3.0 * now->around.squeeze * rest > kLossPerStep;
    // the last two alike, but where there is nothing left at the end
    double dt = rest <= longest ? rest : rest < 2.0 * longest && !lets_go ? 0.5 * rest : longest;
    // the last bounce of all lasts beyond the pressure: it is left where it is
    if (!(now->s + dt > now->s) || 2.0 * now->plain.v * now->around.quickness > now->around.P)
      return {ChatterEnd::exits, now->s, now->plain};
    dt = std::min(dt, bearable);
    new (next) ChatterPlace(rates_.step(guide, *now, dt));
    while (goes_too_far(*now, *next)) {
      dt *= 0.5;
      if (!(now->s + dt > now->s)) return {ChatterEnd::exits, now->s, now->plain};
      new (next) ChatterPlace(rates_.step(guide, *now, dt));
    }
    bearable = until;
    if (exits && next->plain.n >= std::floor(now->plain.n) + 1.0) {
      const double strained = strain(next->around, next->plain.v, true);
      if (strained <= 1.0) bearable = bearable_time(*next, strained);
      if (strained > 1.0 || bearable < kFewBounces * duration(*next)) return whole_bounce(guide, *now, *next, strained);
    }
    std::swap(now, next);
  }
  return {now->plain.v <= threshold_ ? ChatterEnd::died : ChatterEnd::time, now->s, now->plain};
}

ChatterRun ChatterLaw::run(const SlidePiece<double>& guide, double from, double until, const Chatter& start) const {
  return follow(guide, from, until, start, true);
}

Chatter ChatterLaw::at(const SlidePiece<double>& guide, double s, const Chatter& start) const {
  return follow(guide, 0.0, s, start, false).chatter;
}

AFM_MULTIVERSION Settled settle(const Model& model, const TipState& state) {
  const auto p = projected<double>(mobility(model), model.H, {state.phase, state.X, state.u, state.g1});
  return {p.guide, p.normal_speed, p.tangential_velocity};
}

AFM_MULTIVERSION TipState unsettle(const Model& model, const SlideState<double>& guide, double normal_speed) {
  const Bounce4<double> b = launched<double>(mobility(model), model.H, guide, normal_speed);
  return {wrap_phase(b.phase), b.X, b.u, 0.0, b.g1};
}

}  // namespace afm
