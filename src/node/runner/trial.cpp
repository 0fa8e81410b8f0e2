// The pace that a run will reach, before it begins.
#include "runner.h"

namespace afm::node {
namespace {

// The first is for caches and the transient of the initial state; the second is long enough for a tenth.
constexpr std::chrono::milliseconds kWarmUp{5}, kTrial{20};

// Model time that passes [tau] in so much wall time, over that wall time [s].
double advance_for(std::chrono::nanoseconds wall, Run& run, Batch& batch, std::uint64_t impacts) {
  const auto begin = monotonic_now();
  const ModelTime start = run.now();
  auto now = begin;
  for (; now - begin < wall; now = monotonic_now()) run.advance(run.now() + 1.0, impacts, batch);
  return (run.now() - start) / std::chrono::duration<double>(now - begin).count();
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
