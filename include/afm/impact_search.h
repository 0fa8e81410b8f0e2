// The first time after the start of a flight at which the gap is 0 and falling. No root is ever passed: every step is
// bounded by the third derivative of the gap, and a root is finished only inside an interval where it is certified to
// be the only one.
#pragma once

#include "afm/detail/impact_steps.h"
#include "afm/detail/root_finish.h"
#include "flight.h"

namespace afm {

enum class SearchOutcome {
  impact,     // found: `s` and `jet` are at the root
  clear,      // certified free of impacts up to `s`: the horizon, or as far as many evaluations have come
  undecided,  // a graze or a root that rounding hides; certified free up to `s`. More digits decide it
  cap         // too many steps; certified free up to `s`
};

template <class T>
struct Landing {
  SearchOutcome outcome;
  T s;
  GapJet<T> jet;    // of an impact: incident state at `s`; g is what rounding left
  int evaluations;  // of the gap
};

constexpr int kMaxSearchSteps = 20000;
// A flight without an impact is searched this far and then begun anew from there [tau].
constexpr double kSearchHorizon = 8.0;

namespace search_detail {

// Rounding hides the root: the gap seems not to fall within the interval, or no step gets to the root.
template <class T>
Landing<T> hidden_root(const Flight<T>& f, const T& s, const RootInterval<T>& root, int evaluations) {
  const T before = root.low < T(0.0) ? T(s + root.low) : s;
  return {SearchOutcome::undecided, before, f.gap(before), evaluations};
}

// Of a gap below its rounding at s: one step of Newton's to the root.
template <class T>
Landing<T> land(const Flight<T>& f, const T& s, const GapJet<T>& jet, int evaluations) {
  using std::abs;
  using std::sqrt;
  const T step = -jet.g / jet.g1;
  const bool nudge = abs(step) * f.fastest() <= T(0.5) * sqrt(epsilon<T>());
  if (nudge) return {SearchOutcome::impact, s + step, nudged(f, jet, step), evaluations};
  return {SearchOutcome::impact, s + step, f.gap_near(jet, s, step), evaluations + 1};
}

// Lemma 6: finishes the certified root about `jet`, of time s. Steps by series within the root's interval, which each
// evaluation makes smaller; by halves where they would leave it.
template <class T>
Landing<T> finish(const Flight<T>& f, const T& s, GapJet<T> jet, const RootInterval<T>& root, int evaluations) {
  using std::abs;
  constexpr int kMaxSteps = 60;  // by halves alone: every bit of a double
  if (jet.g1 < T(0.0) && abs(jet.g) <= f.gap_error(s)) return land(f, s, jet, evaluations);
  T t(0.0), step = root.estimate, low = root.low, high = root.high;
  for (int i = 0; i < kMaxSteps; ++i) {
    jet = f.gap_near(jet, s + t, step);
    t = t + step;
    ++evaluations;
    if (!(jet.g1 < T(0.0))) break;
    if (abs(jet.g) <= f.gap_error(s + t)) return land(f, s + t, jet, evaluations);
    step = root_step(f, jet);
    (jet.g > T(0.0) ? low : high) = t;
    if (!(low <= t + step && t + step <= high)) step = (low + high) / T(2.0) - t;  // also where it is no number
  }
  return hidden_root(f, s, root, evaluations);
}

// Where the next evaluation goes, as a part of the certified step: it is to certify what lies behind itself too (Lemma 2),
// and a step reaches as far backwards as forwards if the gap does not shrink. docs/history.md: what it saves.
constexpr double kAhead = 0.8;

// Where to evaluate first below the crest: after a fall of 0.46 H at the greatest vertical speed. Most tips land later.
template <class T>
T descent(const Flight<T>& f, const T& reach) {
  using std::min;
  const Mechanics<T>& m = f.mechanics();
  return min(T(kAhead) * reach, T(0.46) * m.H / (m.omega_v * f.amplitude_Y()));
}

// What the loop carries: certified free of impacts up to s; the next evaluation is at s + ahead; the next trial step.
template <class T>
struct Progress {
  T s, ahead, trial;
};

// Lemma 5, and Lemma 4 where it applies.
template <class T>
Progress<T> take_off(const Flight<T>& f) {
  using std::max;
  const T first = time_to_leave(f), aloft = time_above_crest_from_launch(f, first), trial = T(2.0) * first;
  if (aloft > first) return {aloft, descent(f, first), trial};
  // where the root of the parabola is near, the impact is nearly there
  const bool returns = f.start().g2 * first < T(-1.6) * f.start().g1;
  if (!returns) return {first, T(kAhead) * first, trial};
  const T parabola = T(-2.0) * f.start().g1 / f.start().g2;
  return {first, max(T(0.0), T(quartic_root(f, f.start(), parabola) - first)), trial};
}

}  // namespace search_detail

// Searches from the start to the horizon, or from `from`, up to which the flight is known to be free of impacts. A flight
// that starts on the surface falling is an impact at once; one that neither rises nor is released has no flight: contact
// is the tip's affair. Each pass evaluates the gap, then finishes a certified root or goes on by a certified step.
template <class T>
Landing<T> find_impact(const Flight<T>& f, const T& horizon, const T& from = T(0.0)) {
  using std::min;
  const bool on_surface = !(f.start().g > T(0.0)) && !(from > T(0.0));
  if (on_surface && f.start().g1 < T(0.0)) return {SearchOutcome::impact, T(0.0), f.start(), 0};
  search_detail::Progress<T> now{from, T(0.0), T(0.05)};
  if (on_surface) now = search_detail::take_off(f);
  for (int evaluations = 1; evaluations <= kMaxSearchSteps; ++evaluations) {
    if (!(now.s < horizon)) return {SearchOutcome::clear, horizon, f.start(), evaluations - 1};
    now.ahead = min(now.ahead, T(horizon - now.s));
    const T p = now.s + now.ahead, error = f.gap_error(p);
    const GapJet<T> jet = p > T(0.0) ? f.gap(p) : f.start();
    if (now.ahead > T(0.0) && !positive_behind(f, jet, error, now.ahead)) {
      const RootInterval<T> behind = certify_root_behind(f, jet, error, now.ahead);
      if (behind.certain) return search_detail::finish(f, p, jet, behind, evaluations);
      now.ahead = T(0.0);
      continue;
    }
    now.s = p;
    const RootInterval<T> root = certify_root(f, jet, error);
    if (root.certain) return search_detail::finish(f, p, jet, root, evaluations);
    const T above = time_above_crest(f, jet.state);
    if (above > T(0.0)) {
      now = {p + above, search_detail::descent(f, now.trial), now.trial};
      continue;
    }
    const T step = safe_step(f, jet, error, now.trial);
    if (!(step > T(4.0) * epsilon<T>() * p)) return {SearchOutcome::undecided, p, jet, evaluations};
    T ahead = step * T(search_detail::kAhead);
    if (root.estimate > step) ahead = min(ahead, T(root.estimate - step));
    now = {p + step, ahead, step * T(2.0)};
  }
  return {SearchOutcome::cap, now.s, f.gap(now.s), kMaxSearchSteps};
}

// In double; where rounding leaves a graze or a root undecided, again in double-double from the same start (Lemma 7). So
// an impact or a miss is what exact arithmetic on the given doubles says, down to 1e-30. What even double-double cannot
// decide, or too many evaluations, is a touch where no gap is left, clear so far where 0.1 tau are certified, and `cap`
// otherwise.
Landing<double> find_landing(const Model& model, const Flight<double>& flight, double horizon);

}  // namespace afm
