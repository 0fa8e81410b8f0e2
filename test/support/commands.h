// Short commands to a run.
#pragma once

#include <cstdint>

#include "afm/run.h"

namespace afm {

inline double drag(Run& run, double eta) {
  LiveSettings live = live_settings(run.settings());
  live.eta = eta;
  return run.apply(live);
}

inline Outcome advance_to(const ModelTime& time, Run& run, Batch& batch) {
  return run.advance(time, run.settings().impact_budget, batch);
}

// To the n-th next impact, or to the next batch boundary.
inline Outcome advance_impacts(std::uint64_t n, Run& run, Batch& batch) { return run.advance(kEndOfTime, n, batch); }

}  // namespace afm
