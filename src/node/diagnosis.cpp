#include "diagnosis.h"

namespace afm::node {
namespace {

using Level = diagnostic_msgs::DiagnosticStatus;

}  // namespace

void diagnose_pace(const Health& health, Diagnosis& out) {
  const afm_emulator::EmulatorStatus& status = health.status;
  if (health.lost_batch) {
    out.summary(Level::ERROR, "batches were lost: publishing does not keep up");
  } else if (status.lag > kHopelessLag) {
    out.summaryf(Level::ERROR, "%.1f s behind the wall clock: the machine is too slow for this run", status.lag);
  } else if (status.lag > kTroublingLag) {
    out.summaryf(Level::WARN, "%.1f s behind the wall clock", status.lag);
  } else if (health.late_share > kTroublingLateShare) {
    out.summaryf(Level::WARN, "%.0f %% of the batches are late (scheduler: %s)", 100.0 * health.late_share,
                 status.scheduler.c_str());
  } else {
    out.summary(Level::OK, status.paused ? "paused" : "running");
  }
  out.add("real-time factor", status.real_time_factor);
  out.add("lag [s]", status.lag);
  out.add("worst lag [s]", status.worst_lag);
  out.add("late batches", status.late_batches);
  out.addf("late batches since the last look", "%.1f %%", 100.0 * health.late_share);
  out.add("scheduler", status.scheduler);
  out.add("dropped messages", status.dropped_messages);
}

void diagnose_commands(const Health& health, Diagnosis& out) {
  if (health.overload) {
    out.summary(Level::ERROR, health.refusal);
  } else if (!health.refusal.empty()) {
    out.summary(Level::WARN, "refused: " + health.refusal);
  } else if (health.timed_out) {
    out.summaryf(Level::WARN, "the drag was stopped: no command for %g s (command_timeout_s)",
                 health.command_timeout_s);
  } else {
    out.summary(Level::OK, "all obeyed of late");
  }
  out.add("refused drag commands", health.status.refused_commands);
  out.add("refused changes of parameters", health.refused_changes);
  out.add("drag stopped as no command came", health.timed_out);
}

void diagnose_numerics(const Health& health, Diagnosis& out) {
  const afm_emulator::EmulatorStatus& status = health.status;
  if (status.search_failures > 0) {
    out.summary(Level::ERROR, "searches for the next impact have given up: this epoch is not exact");
  } else if (status.worst_penetration > kPenetration * health.lattice_spacing_m) {
    out.summary(Level::ERROR, "the tip was below the surface: this epoch is not exact");
  } else if (health.budget_spent) {
    out.summary(Level::WARN, "batches are cut short by the impact budget: too many impacts for real time");
  } else {
    out.summary(Level::OK, "exact");
  }
  out.add("failed impact searches", status.search_failures);
  out.add("worst penetration [m]", status.worst_penetration);
  out.add("batches cut short by the impact budget", status.budget_exhausted);
  out.add("impacts per tau", status.impacts_per_tau);
}

void diagnose_recording(const Health& health, Diagnosis& out) {
  const afm_emulator::EmulatorStatus& status = health.status;
  const bool recording = !status.recording.empty();
  const bool scarce = health.free_mb >= 0.0 && health.free_mb < kScarceReserves * health.reserve_mb;
  if (!status.recorder_error.empty()) {
    out.summary(Level::ERROR, "ended early: " + status.recorder_error);
  } else if (recording && health.dropped_from_recording > 0) {
    out.summary(Level::ERROR, "messages are missing in the recording: the disk is too slow");
  } else if (scarce) {
    out.summaryf(Level::WARN, "%.0f MB are free, and recordings end at %.0f MB (disk_reserve_mb)", health.free_mb,
                 health.reserve_mb);
  } else {
    out.summary(Level::OK, recording ? "recording" : "not recording");
  }
  out.add("bag", status.recording);
  if (health.free_mb >= 0.0) out.addf("free [MB]", "%.0f", health.free_mb);
  out.add("messages missing in the recording", health.dropped_from_recording);
}

}  // namespace afm::node
