// The error of a level of the model (level.h) against a finer one: friction and deflection (docs/friction.md). Natural
// units.
#pragma once

#include <cstdint>
#include <vector>

#include "afm/level.h"
#include "afm/model.h"
#include "afm/tip.h"
#include "attractor.h"
#include "afm/time_average.h"

namespace afm {

struct ErrorSettings {
  double transient = 500.0;            // [tau]
  double duration = 2000.0;            // of the measurement of K_f [tau]
  double periodic_duration = 1e9;      // the same for a periodic orbit, if that is less [tau]
  std::uint64_t most_events = 500000;  // a level that needs more is measured for a shorter time
  double most_events_per_tau = 1e9;    // a level that needs more is not measured
  int samples = 20000;                 // of the deflection, 0.618 tau apart, so that their phases fill [0, 1) evenly
  int periodic_samples = 1000000000;   // the same for a periodic orbit, if that is less
  int pairs = 200;                     // of runs from one state, compared over one tau
};

// Results of one level on its attractor.
struct LevelRun {
  Attractor attractor;
  FrictionAverage friction;
  std::vector<double> vertical;                     // deflections y - y0 in order of size [a]
  double vertical_rms = 0.0;                        // [a]
  double vertical_noise = 0.0;                      // distance of the samples' first half from the second [a]
  double stretch_rms = 0.0, stretch_largest = 0.0;  // of the horizontal spring, x - xc [a]
  double share_measured = 1.0;                      // part of the duration; 0: the budget ran out in the transient
};

// Leaves `tip` on its attractor. Precondition: `tip` has the level of `model`.
LevelRun run_level(const Model& model, Tip& tip, const ErrorSettings& settings);

// Mean distance of equal quantiles of two sorted sets (Wasserstein distance of order 1) [a].
double quantile_distance(const std::vector<double>& a, const std::vector<double>& b);

// Root mean square difference of the vertical deflection over one tau, after the level has started from the state of
// the reference [a]. Advances the reference.
double tracking_error(const Model& model, const Level& level, Tip& reference, const ErrorSettings& settings);

}  // namespace afm
