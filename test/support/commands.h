// Settings of a run, and short commands to it.
#pragma once

#include <cstdint>

#include "afm/run.h"

namespace afm {

// The paper's tip, well above the surface, dragged along with its holder.
inline RunSettings settings_at(double eta, std::uint64_t samples_per_batch = 200, double sample_period = 0.03) {
  RunSettings settings;
  settings.eta = eta;
  settings.initial = {0.25, 0.0, 0.2, eta, 0.0};
  settings.sample_period = sample_period;
  settings.samples_per_batch = samples_per_batch;
  return settings;
}

inline double drag(Run& run, double eta) {
  RunSettings settings = run.settings();
  settings.eta = eta;
  return run.apply(settings);
}

inline Outcome advance_to(const ModelTime& time, Run& run, Batch& batch) {
  return run.advance(time, run.settings().impact_budget, batch);
}

// To the n-th next impact, or to the next batch boundary.
inline Outcome advance_impacts(std::uint64_t n, Run& run, Batch& batch) { return run.advance(kEndOfTime, n, batch); }

}  // namespace afm
