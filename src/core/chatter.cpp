#include "afm_emulator/chatter.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "afm_emulator/multiversion.h"

namespace afm {
namespace {

// |w| up to which the series below are good to 3e-4
constexpr double kMostLoss = 0.2;
// The duration of a bounce against the time in which the pressure changes by itself, at most: an exit leaves two
// bounces.
constexpr double kMostShortness = 0.05;
// A tip that rings over a crest, where none rides faster than about 1 a/tau, bounces thousands of times a tau for
// hundreds of tau, and more than three hundred of them last longer than that. What it costs to average them is a part
// of the normal speed: slower ones may last longer.
constexpr double kRinging = 1.5;         // [a/tau] at most
constexpr double kFullSpeed = 1e3;       // thresholds: bounces of a ringing tip slower than this may last longer
constexpr double kMostLongerSlow = 3.0;  // times at most

// A step, in parts of the times in which v falls and the reaction changes.
constexpr double kFallPerStep = 0.7, kChangePerStep = 0.2;
// the pressure may fall to this part of itself in a step, and v rise to so many times itself; and where it ends, a
// bounce may outlast the pressure so many times
constexpr double kMostFall = 0.75, kMostRise = 2.0, kMostOutlasting = 4.0;

double square(double x) { return x * x; }

}  // namespace

// When n is reached in a step between two ends: the cubic through both with the bounces' durations as its slopes.
double ChatterLaw::time_at(double n, const Pace& first, const Pace& last, double dt) {
  const double bounces = last.n - first.n, x = (n - first.n) / bounces, rest = 1.0 - x;
  return dt * x * x * (3.0 - 2.0 * x) + bounces * x * rest * (first.duration * rest - last.duration * x);
}

ChatterLaw::ChatterLaw(const Model& model, double threshold)
    : v_c_(model.v_c),
      threshold_(threshold),
      rates_(model, !(model.v_c > threshold)),
      threshold_x_(rates_.x_of(std::max(threshold, 1e-300))) {
  constexpr double kUsualThreshold = 1e-5;
  fineness_ = std::sqrt(std::sqrt(std::min(1.0, threshold / kUsualThreshold)));
  whole_ = std::max(1e-12, 1e-6 * std::min(1.0, threshold / kUsualThreshold));
}

// What the averages leave out is of the third and fourth order of a bounce's duration against all changes. `within` a
// burst, or at the entry to one: there bounces of a falling pressure, which lengthen, may not last longer.
bool ChatterLaw::smooth(const ChatterSurroundings& at, double v, bool within) const {
  double most = kMostShortness * fineness_;
  if (at.speed <= kRinging && (within || at.squeeze >= 0.0))
    most *= std::clamp(std::sqrt(kFullSpeed * threshold_ / v), 1.0, kMostLongerSlow);
  return 2.0 * v * at.per_P * std::max(at.quickness, at.slow_rate) <= most;
}

AFM_MULTIVERSION bool ChatterLaw::holds(const Flight<double>& bounce) const {
  const double v = bounce.start().g1;
  if (v <= threshold_) return true;
  if (!(bounce.start().g2 < 0.0)) return false;
  const bool below = v_c_ > threshold_;
  if (below && (v > v_c_ || rates_.loss(v) > kMostLoss)) return false;
  return smooth(rates_.surroundings(bounce), v, false);
}

// Parts of the times in which v and P change by themselves. Smaller thresholds take smaller steps.
double ChatterLaw::step_length(const ChatterSurroundings& at, double v, const EvenChatter& c, double fall) const {
  // with a cutoff, the less a bounce loses the more evenly ln v falls
  const double loss = v_c_ > threshold_ ? std::min(kMostLoss, rates_.loss(v)) : kMostLoss, evenness = 0.5 + 2.5 * loss;
  // the error of a step is that of a pressure which swings with the horizontal spring: the less it changes by, the longer
  const double change = std::sqrt(at.quickness * std::max(at.quickness, kTwoPi * at.slow_rate));
  const double dt = fineness_ * std::min(kFallPerStep / evenness * rates_.fall_time(at, v), kChangePerStep / change);
  // and not far beyond the threshold, so that n counts the bounces down to it
  return fall > 0.0 ? std::min(dt, 1.02 * (c.x - threshold_x_) / fall) : dt;
}

// The first whole n in a step of which both ends are known: bracketed, as n only grows.
ChatterRun ChatterLaw::whole_bounce(const SlidePiece<double>& guide, double s, double dt, const EvenChatter& rate,
                                    const EvenChatter& start, const Pace& first, const Pace& last) const {
  const double n = std::floor(first.n) + 1.0;
  double low = 0.0, high = dt, part = time_at(n, first, last, dt);
  if (!(part > low && part < high)) part = dt * (n - first.n) / (last.n - first.n);
  Chatter c{};
  double before = 0.0, n_before = first.n;
  constexpr int kMostSteps = 40;
  for (int i = 0; i < kMostSteps; ++i) {
    const ChatterAhead ahead = rates_.ahead(guide, s, part);
    c = rates_.plain(ahead.end, rates_.step(part, rate, ahead, start));
    const double rest = n - c.n;
    if (std::abs(rest) < whole_) break;
    (rest > 0.0 ? low : high) = part;
    const double duration = i == 0 ? 2.0 * c.v * ahead.end.per_P : (part - before) / (c.n - n_before);
    before = part, n_before = c.n;
    const double next = part + rest * duration;
    part = next > low && next < high ? next : 0.5 * (low + high);
  }
  return {ChatterEnd::exits, s + part, {c.v, n, c.sigma, c.p, c.drift, c.lift}};
}

// A step that ends where the interpolation no longer holds is gone back from, to its first whole bounce. Without exits,
// for the state in the middle of a burst, it is not asked.
AFM_MULTIVERSION ChatterRun ChatterLaw::follow(const SlidePiece<double>& guide, double from, double until,
                                               const Chatter& start, bool exits) const {
  double s = from;
  Chatter now = start;
  ChatterSurroundings at = rates_.surroundings(guide, s);
  EvenChatter c = rates_.even(at, start);
  while (s < until && now.v > threshold_) {
    const EvenChatter rate = rates_(at, c);
    const double rest = until - s, longest = step_length(at, now.v, c, -rate.x);
    double dt = rest <= longest ? rest : rest < 2.0 * longest ? 0.5 * rest : longest;  // the last two alike
    // the last bounce of all lasts beyond the pressure: it is left where it is
    if (!(s + dt > s) || 2.0 * now.v * at.quickness > at.P) return {ChatterEnd::exits, s, now};
    ChatterSurroundings then;
    EvenChatter next;
    Chatter plain;
    // past a maximum the pressure may fall faster than its rate foretells; at rest on a crest nothing tells of a holder
    // that has just been made fast
    const auto goes_too_far = [&] {
      const ChatterAhead ahead = rates_.ahead(guide, s, dt);
      then = ahead.end;
      if (!(then.P > kMostFall * at.P) || 2.0 * now.v * then.quickness > kMostOutlasting * then.P) return true;
      next = rates_.step(dt, rate, ahead, c);
      plain = rates_.plain(then, next);
      return !(plain.v < kMostRise * now.v) || !std::isfinite(plain.n);
    };
    while (goes_too_far()) {
      dt *= 0.5;
      if (!(s + dt > s)) return {ChatterEnd::exits, s, now};
    }
    if (exits && !smooth(then, plain.v, true) && plain.n >= std::floor(now.n) + 1.0)
      return whole_bounce(guide, s, dt, rate, c, {now.n, 2.0 * now.v * at.per_P},
                          {plain.n, 2.0 * plain.v * then.per_P});
    s += dt;
    c = next;
    now = plain;
    at = then;
  }
  return {now.v <= threshold_ ? ChatterEnd::died : ChatterEnd::time, s, now};
}

ChatterRun ChatterLaw::run(const SlidePiece<double>& guide, double from, double until, const Chatter& start) const {
  return follow(guide, from, until, start, true);
}

Chatter ChatterLaw::at(const SlidePiece<double>& guide, double s, const Chatter& start) const {
  return follow(guide, 0.0, s, start, false).chatter;
}

AFM_MULTIVERSION Settled settle(const Model& model, const TipState& state) {
  const double slope = mobility(model) * surface_jet(model.H, state.phase).h1;
  const double N2 = 1.0 + square(slope), N = std::sqrt(N2);
  const double u = state.u + slope * state.g1 / N2;
  return {{state.phase, state.X, u}, state.g1 / N, u * N};
}

AFM_MULTIVERSION TipState unsettle(const Model& model, const SlideState<double>& guide, double normal_speed) {
  const double slope = mobility(model) * surface_jet(model.H, guide.phase).h1, N = std::sqrt(1.0 + square(slope));
  return {wrap_phase(guide.phase), guide.X, guide.u - slope * normal_speed / N, 0.0, normal_speed * N};
}

}  // namespace afm
