// The pace that a run will reach, before it begins.
#include <ctime>

#include "runner.h"

namespace afm::node {
namespace {

// The first is for caches and the transient of the initial state; the second is long enough for a tenth.
constexpr double kWarmUp = 5e-3, kTrial = 20e-3;  // [s]

// Processor time of this process, whose other threads still wait [s]: the wall clock measures other programs too.
double processor_seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

// Model time that passes [tau] in so many seconds, over these seconds.
double advance_for(double seconds, Run& run, Batch& batch, std::uint64_t impacts) {
  const double begin = processor_seconds();
  const ModelTime start = run.now();
  double now = begin;
  for (; now - begin < seconds; now = processor_seconds()) run.advance(run.now() + 1.0, impacts, batch);
  return (run.now() - start) / (now - begin);
}

}  // namespace

double measure_pace(const Parameters& p) {
  RunSettings settings = run_settings(p);
  LiveSettings live = live_settings(settings);
  live.level = choose_level(p, settings).level;
  Run run(settings);
  run.apply(live);
  constexpr std::uint64_t kImpacts = 1000;  // at once, so that the clock is read often enough
  Batch batch = preallocated_batch(p);
  advance_for(kWarmUp, run, batch, kImpacts);
  return advance_for(kTrial, run, batch, kImpacts) * Units(p.si).time();
}

}  // namespace afm::node
