#include "health.h"

namespace afm::node {

HealthTracker::HealthTracker(double lattice_spacing_m, double command_timeout_s, double reserve_mb) {
  unchanging_.lattice_spacing_m = lattice_spacing_m;
  unchanging_.command_timeout_s = command_timeout_s;
  unchanging_.reserve_mb = reserve_mb;
}

Health HealthTracker::update(const Sources& sources, RecentRise::Time now) {
  Health health = unchanging_;
  health.status = sources.status;
  const RunnerState& runner = sources.runner;
  const std::uint64_t batches = runner.batches - batches_, late = runner.late_batches - late_;
  health.late_share = batches > 0 ? static_cast<double>(late) / static_cast<double>(batches) : 0.0;
  batches_ = runner.batches;
  late_ = runner.late_batches;
  health.lost_batch = lost_.update(runner.dropped_batches, now);
  health.budget_spent = budget_.update(runner.counters.budget_exhausted, now);
  health.timed_out = runner.timed_out;
  health.refused_changes = sources.refusals.changes();
  const auto refusal = sources.refusals.latest();
  if (refusal && now - refusal->when < kRecently) {
    health.refusal = refusal->text;
    health.overload = refusal->kind == Refusal::overload;
  }
  if (sources.free_bytes >= 0) health.free_mb = static_cast<double>(sources.free_bytes) / 1e6;
  health.dropped_from_recording = sources.recorder.dropped_from_recording;
  return health;
}

}  // namespace afm::node
