// How far a simpler level of the model is from a fuller one: friction and deflection of both. Natural units.
#pragma once

#include <cstdint>
#include <vector>

#include "attractor.h"
#include "afm/level.h"
#include "afm/model.h"
#include "time_average.h"
#include "afm/tip.h"

namespace afm {

struct ErrorSettings {
  double transient = 500.0;            // [tau]
  double duration = 2000.0;            // of the measurement of K_f [tau]
  double periodic_duration = 1e9;      // where the orbit repeats itself, if that is less
  std::uint64_t most_events = 500000;  // a level that needs more is measured for a shorter time
  double most_events_per_tau = 1e9;    // one that needs more is not measured
  int samples = 20000;                 // of the deflection, a golden section of tau apart: phases of tau evenly
  int periodic_samples = 1000000000;   // where the orbit repeats itself, if that is less
  int pairs = 200;                     // of runs from one state, compared over one tau
};

// One level, followed from a start to its attractor and along it.
struct LevelRun {
  Attractor attractor;
  FrictionAverage friction;
  std::vector<double> vertical;                    // deflections y - y0 in order of size [a]
  double vertical_rms = 0.0;                       // [a]
  double vertical_noise = 0.0;                     // distance of the samples' first half from the second [a]
  double stretch_rms = 0.0, stretch_largest = 0.0;  // of the horizontal spring, x - xc [a]
  double share_measured = 1.0;                     // of the duration; 0: the budget was gone before anything was seen
};

// Leaves `tip`, which is of the level, on its attractor.
LevelRun run_level(const Model& model, Tip& tip, const ErrorSettings& settings);

// Mean distance of equal quantiles (Wasserstein's of order 1) of two sets in order of size, of one length [a].
double quantile_distance(const std::vector<double>& a, const std::vector<double>& b);

// Root mean square difference of the vertical deflection over one tau, where the level takes over the reference's
// phase, height and vertical velocity in the midst of its motion [a]. Moves the reference on.
double tracking_error(const Model& model, const Level& level, Tip& reference, const ErrorSettings& settings);

}  // namespace afm
