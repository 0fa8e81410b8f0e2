// The first time after the start of a flight at which the gap is 0 and falling. No root is ever passed: every step is
// bounded by the third derivative of the gap, and a root is finished only inside an interval where it is certified to be
// the only one.
#pragma once

#include "afm_emulator/flight.h"
#include "afm_emulator/impact_steps.h"

namespace afm {

enum class SearchOutcome {
  impact,     // found: `s` and `jet` are at the root
  clear,      // certified free of impacts up to the horizon, `s`
  undecided,  // a graze that rounding hides at `s`; certified free up to there. More digits decide it
  cap         // too many steps; certified free up to `s`
};

template <class T>
struct Landing {
  SearchOutcome outcome;
  T s;
  GapJet<T> jet;    // incident state at `s`; g is what rounding left
  int evaluations;  // of the gap
};

constexpr int kMaxSearchSteps = 20000;

namespace search_detail {

// Finishes a certified root near f.gap(s + t), t in [0, d]. Halley's steps, clamped: outside there is nothing to find.
template <class T>
Landing<T> finish(const Flight<T>& f, const T& s, T t, const T& d, int evaluations) {
  using std::abs;
  using std::sqrt;
  const T near_enough = sqrt(epsilon<T>()) / T(16.0);
  constexpr int kMaxFinish = 60;
  for (int i = 0; i < kMaxFinish; ++i) {
    GapJet<T> jet = f.gap(s + t);
    ++evaluations;
    const T ratio = jet.g / jet.g1;
    const T halley = -ratio / (T(1.0) - ratio * jet.g2 / (jet.g1 * T(2.0)));
    const T next = clamp(t + halley, T(0.0), d);
    const T step = next - t;
    // well below an ulp of the velocities: what is left out there always adds energy
    const bool smooth = T(16.0) * f.third_derivative_bound() * step * step <= epsilon<T>() * abs(jet.g1);
    const bool hidden = abs(step * jet.g1) <= f.gap_error(s + t);  // by the rounding of the gap
    if (hidden || (smooth && abs(step) <= near_enough * (s + t))) {
      // what is left is of second order at most: move the evaluated state instead of evaluating again
      return {SearchOutcome::impact, s + next, drift(f, jet, step), evaluations};
    }
    t = next;
  }
  return {SearchOutcome::cap, s, f.gap(s), evaluations};
}

}  // namespace search_detail

// Searches from the start to the horizon. A flight that starts on
// the surface falling is an impact at once; one that neither rises nor is let go has no flight: contact is the tip's affair.
template <class T>
Landing<T> find_impact(const Flight<T>& f, const T& horizon) {
  const bool on_surface = !(f.start().g > T(0.0));
  if (on_surface && f.start().g1 < T(0.0)) return {SearchOutcome::impact, T(0.0), f.start(), 0};
  T s = on_surface ? leave_surface(f) : T(0.0);
  T guess = on_surface ? s : T(0.05);
  for (int evaluations = 1; evaluations <= kMaxSearchSteps; ++evaluations) {
    if (s > horizon) s = horizon;
    const GapJet<T> jet = f.gap(s);
    const T error = f.gap_error(s);
    const RootInterval<T> root = certify_root(f, jet, error);
    if (root.certain) return search_detail::finish(f, s, root.estimate, root.length, evaluations);
    if (!(s < horizon)) return {SearchOutcome::clear, s, jet, evaluations};
    const T above = time_above_crest(f, jet.state);
    if (above > T(0.0)) {
      s = s + above;
      continue;
    }
    const T step = safe_step(f, jet, error, guess);
    if (!(step > T(4.0) * epsilon<T>() * s)) return {SearchOutcome::undecided, s, jet, evaluations};
    guess = step * T(2.0);
    s = s + step;
  }
  return {SearchOutcome::cap, s, f.gap(s), kMaxSearchSteps};
}

// In double, and where rounding hides a graze, on the same start in twice the digits; one that even they cannot tell from
// a touch is a touch. So an impact or a miss is what exact arithmetic on the given doubles says, down to 1e-30.
Landing<double> find_landing(const Model& model, const Flight<double>& flight, double horizon);

}  // namespace afm
