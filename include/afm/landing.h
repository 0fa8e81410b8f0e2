// The first impact of a flight: the first time at which the gap is 0 and falling. docs/algorithm.md explains the search
// and proves its lemmas; its loop is in src/core/search/impact_search.h. Guarantee: no impact is missed.
#pragma once

#include "flight.h"
#include "model.h"

namespace afm {

enum class SearchOutcome {
  impact,     // found: `s` and `jet` are at the root
  clear,      // certified free of impacts up to `s`, which is the horizon or where the evaluations ran out
  undecided,  // a graze, or a root that rounding hides; certified free up to `s`. Double-double decides it (Lemma 7)
  cap         // too many evaluations; certified free up to `s`
};

template <class T>
struct Landing {
  SearchOutcome outcome;
  T s;              // [tau]
  GapJet<T> jet;    // of an impact: the incident state at `s`; g is what rounding left
  int evaluations;  // number of evaluations of the gap
};

// A tip searches its flight so far at once, and goes on from there [tau]. A choice: flights without an impact are rare,
// and the turns stay small.
constexpr double kSearchHorizon = 8.0;

// [tau] So soon after a launch rounding of the gap's acceleration may make a root.
constexpr double kEarlyLanding = 1e-14;

// Searches from the start of the flight to the horizon [tau], in double precision. If rounding leaves the result
// undecided, or may have made an early landing, the search is repeated in double-double from the same start (Lemma 7).
// Guarantee: an impact or a miss is that of exact arithmetic on the given doubles, down to the rounding of
// double-double, about 2e-31 (|y0| + 1) a. If double-double cannot decide either, or the evaluations run out, the
// outcome is: an impact if the gap is at most 1e-17 a, clear if at least 0.1 tau are certified, otherwise cap.
Landing<double> find_landing(const Model& model, const Flight<double>& flight, double horizon);

}  // namespace afm
