// The first impact of a flight: the first time at which the gap is 0 and falling. docs/algorithm.md explains the search
// and proves its lemmas. Guarantee: no impact is missed. Every step is shorter than the certified time without an
// impact. A root is finished inside an interval in which it is certified to be the only one.
#pragma once

#include <algorithm>
#include <cmath>

#include "afm/landing.h"
#include "impact_steps.h"
#include "root_finish.h"

namespace afm::detail {

// Evaluations in one search: a guard against an endless loop. find_landing() says what becomes of the outcome `cap`.
constexpr int kMaxSearchSteps = 20000;
// A root that may be further away is not finished: the horizon comes first [tau]. A tip that falls without a force may
// land beyond all time that can be counted. Any number between the horizon and 1e18 will do.
constexpr double kFarthestRoot = 1e6;

// Rounding hides the root: the gap seems not to fall within the interval, or no step reaches the root.
template <class T>
Landing<T> hidden_root(const Flight<T>& f, const T& s, const RootInterval<T>& root, int evaluations) {
  const T before = root.low < T(0.0) ? T(s + root.low) : s;
  return {SearchOutcome::undecided, before, f.gap(before), evaluations};
}

// From a gap below its rounding at s: one Newton step to the root.
template <class T>
Landing<T> land(const Flight<T>& f, const T& s, const GapJet<T>& jet, int evaluations) {
  using std::abs;
  using std::sqrt;
  const T step = -jet.g / jet.g1;
  const bool nudge = abs(step) * (two_pi<T>() * bounds_of(f).fastest) <= T(0.5) * sqrt(epsilon<T>());
  if (nudge) return {SearchOutcome::impact, s + step, nudged(f, jet, step), evaluations};
  return {SearchOutcome::impact, s + step, gap_near(f, jet, s, step), evaluations + 1};
}

// Lemma 6: finishes the certified root near `at_s`, the jet at time s. Each evaluation shrinks the interval of the
// root. A step of the series that would leave the interval is replaced by bisection.
template <class T>
Landing<T> finish(const Flight<T>& f, const T& s, const GapJet<T>& at_s, const RootInterval<T>& root, int evaluations) {
  using std::abs;
  constexpr int kMaxFinishSteps = 60;  // bisection alone: 53 bits of a double, and a few for the exponent
  if (at_s.g1 < T(0.0) && abs(at_s.g) <= f.gap_error(s)) return land(f, s, at_s, evaluations);
  T t = root.estimate, low = root.low, high = root.high;
  GapJet<T> jet = gap_near(f, at_s, s, t);
  for (int i = 0; i < kMaxFinishSteps; ++i) {
    ++evaluations;
    if (!(jet.g1 < T(0.0))) break;
    if (abs(jet.g) <= f.gap_error(s + t)) return land(f, s + t, jet, evaluations);
    T step = root_step(f, jet);
    (jet.g > T(0.0) ? low : high) = t;
    if (!(low <= t + step && t + step <= high)) step = (low + high) / T(2.0) - t;  // also for NaN
    jet = gap_near(f, jet, T(s + t), step);
    t = t + step;
  }
  return hidden_root(f, s, root, evaluations);
}

// These save evaluations and decide nothing: every step is certified. Their table is in docs/algorithm.md.
// Lookahead as a part of the certified step: the next evaluation certifies the time behind itself too (Lemma 2). Such a
// step reaches as far backwards as forwards if the gap does not shrink.
constexpr double kLookahead = 0.8;
// Lookahead from the crest down: the time of a fall by this part of H at the greatest vertical speed.
constexpr double kDescent = 0.46;
// The first trial step from above the surface [tau].
constexpr double kFirstTrial = 0.05;
// A launch whose gap rate falls by more than this part of itself, within the certified time, returns soon; at -2 the
// parabola is back on the surface.
constexpr double kReturns = -1.6;

template <class T>
T descent(const Flight<T>& f, const T& reach) {
  using std::min;
  const SpringConstants<T>& m = f.springs();
  return min(T(kLookahead) * reach, T(kDescent) * m.H / (m.omega_v * bounds_of(f).Y));
}

// The state of the loop: certified free of impacts up to s; the next evaluation is at s + lookahead; the next trial
// step is `trial`.
template <class T>
struct Progress {
  T s, lookahead, trial;
};

// The certified time after a launch: Lemma 5, and Lemma 4 if the tip rises above the crest.
template <class T>
Progress<T> take_off(const Flight<T>& f) {
  using std::max;
  const T first = time_to_leave(f), aloft = time_above_crest_from_launch(f, first), trial = T(2.0) * first;
  if (aloft > first) return {aloft, descent(f, first), trial};
  // the parabola falls to zero soon: the impact is near its root
  const bool returns = f.start().g2 * first < T(kReturns) * f.start().g1;
  if (!returns) return {first, T(kLookahead) * first, trial};
  const T parabola = T(-2.0) * f.start().g1 / f.start().g2;
  return {first, max(T(0.0), T(quartic_root(f, f.start(), parabola) - first)), trial};
}

// Searches from `from` to the horizon [tau]. Precondition: no impact before `from`. A tip that starts on the surface
// falling is an impact at once. A tip that neither rises nor is released has no flight; the caller treats it as
// contact. Each pass evaluates the gap; then it finishes a certified root, or goes on by a certified step.
template <class T>
Landing<T> find_impact(const Flight<T>& f, const T& horizon, const T& from = T(0.0)) {
  using std::min;
  const bool on_surface = !(f.start().g > T(0.0)) && !(from > T(0.0));
  if (on_surface && f.start().g1 < T(0.0)) return {SearchOutcome::impact, T(0.0), f.start(), 0};
  Progress<T> now{from, T(0.0), T(kFirstTrial)};
  if (on_surface) now = take_off(f);
  for (int evaluations = 1; evaluations <= kMaxSearchSteps; ++evaluations) {
    if (!(now.s < horizon)) return {SearchOutcome::clear, horizon, f.start(), evaluations - 1};
    now.lookahead = min(now.lookahead, T(horizon - now.s));
    const T p = now.s + now.lookahead, error = f.gap_error(p);
    const GapJet<T> jet = p > T(0.0) ? f.gap(p) : f.start();
    if (now.lookahead > T(0.0) && !positive_behind(f, jet, error, now.lookahead)) {
      const RootInterval<T> behind = certify_root_behind(f, jet, error, now.lookahead);
      if (behind.certain) return finish(f, p, jet, behind, evaluations);
      now.lookahead = T(0.0);
      continue;
    }
    now.s = p;
    const RootInterval<T> root = certify_root(f, jet, error);
    if (root.certain && root.high < T(kFarthestRoot)) return finish(f, p, jet, root, evaluations);
    const T above = time_above_crest(f, jet.state);
    if (above > T(0.0)) {
      now = {p + above, descent(f, now.trial), now.trial};
      continue;
    }
    const T step = safe_step(f, jet, error, now.trial);
    if (!(step > T(4.0) * epsilon<T>() * p)) return {SearchOutcome::undecided, p, jet, evaluations};
    T lookahead = step * T(kLookahead);
    if (root.estimate > step) lookahead = min(lookahead, T(root.estimate - step));
    now = {p + step, lookahead, step * T(2.0)};
  }
  return {SearchOutcome::cap, now.s, f.gap(now.s), kMaxSearchSteps};
}

}  // namespace afm::detail
