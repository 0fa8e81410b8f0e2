// How far each level of the model is from the finest at one point of the parameters, and what it costs.
#pragma once

#include <cstdint>
#include <vector>

#include "afm/dynamics/model_error.h"
#include "afm/level_table.h"
#include "afm/tip.h"

namespace afm {

struct LevelErrorSettings {
  LevelErrorSettings() {
    run.transient = 300.0;
    run.duration = 20000.0;
    run.periodic_duration = 1000.0;
    run.periodic_samples = 2000;
    run.most_events = 1000000;
    run.most_events_per_tau = 100.0;
  }
  ErrorSettings run;
  int starts = 2;
  std::uint64_t seed = 1;
};

struct MeasuredLevel {
  Level level;
  LevelError error;
};

// Finest first. Every bounce is the reference where it keeps time, and takes no more events a tau than are allowed;
// elsewhere it is missing, and the finest chatter sequences are, which are given the error of the next coarser ones.
// Levels coarser than the full model that cost more than 1.2 times as much as it are missing too. Where several
// attractors coexist a level is held against the nearest one that the reference comes to. Errors of K_f include two
// standard errors, those of the deflection what two samples of one attractor differ by; both are 0 where the level does
// to the bit what the reference does.
std::vector<MeasuredLevel> measure_levels(const Model& model, double eta, const LevelErrorSettings& settings);

// Processor time of a tau [ns] of each tip: the median of intervals that the tips fly by turns, so that what else the
// machine does meets them alike. Each has an interval of its own: where tips make the same chaotic flights, the first
// would pay a sixth more, as the processor has learned the branches when the others make them. Infinite where a tip
// does not get on.
std::vector<double> nanoseconds_per_tau(std::vector<Tip> tips);

}  // namespace afm
