// One tip that runs for some tau: its processor time, its events, and the energy that they lose.
#pragma once

#include <cstdint>

#include "afm/tip.h"
#include "common/cpu_clock.h"

namespace afm {

struct TipRun {
  double energy = 0.0, events = 0.0;  // lost in impacts [m a^2/tau^2]; impacts
  long search_failures = 0;

  void add(const TipRun& run) { energy += run.energy, events += run.events, search_failures += run.search_failures; }
};

// Up to the given time [tau].
inline TipRun run_tip(Tip& tip, std::int64_t end) {
  TipRun run;
  const std::uint64_t failures = tip.search_failures();
  for (;;) {
    const Outcome outcome = tip.advance({end, 0.0});
    run.search_failures = static_cast<long>(tip.search_failures() - failures);
    if (outcome == Outcome::time_limit || outcome == Outcome::search_failed) return run;
    if (outcome != Outcome::impact) continue;
    run.energy += tip.last_impact().energy_loss;
    run.events += tip.last_impact().count;
  }
}

struct TimedRun {
  TipRun run;          // after the transient
  double seconds = 0;  // processor time for a tau
};

// Of a transient and of the tau after it.
inline TimedRun time_tip(Tip tip, std::int64_t transient, std::int64_t tau) {
  TimedRun timed;
  const double begin = thread_seconds();
  timed.run.search_failures = run_tip(tip, transient).search_failures;
  for (std::int64_t t = 1; t <= tau; ++t) timed.run.add(run_tip(tip, transient + t));
  timed.seconds = (thread_seconds() - begin) / static_cast<double>(transient + tau);
  return timed;
}

// As every measurement of time begins: a tip that falls on the flank of the surface, or that was lowered into a valley
// if the load holds it down there.
inline Tip tip_at_start(const Model& model, double eta, const Bath& bath,
                        double tolerance = kDefaultContactTolerance) {
  Tip tip(model, eta, is_held_down(model) ? lowered_tip(model.H) : FreeState{0.25, 0.0, 0.2, eta, 0.0}, tolerance);
  tip.set_bath(bath);
  return tip;
}

}  // namespace afm
