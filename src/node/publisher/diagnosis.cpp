#include "diagnosis.h"

#include <cstdio>
#include <string>

namespace afm::node {
namespace {

using Severity = diagnostic_msgs::DiagnosticStatus;

// Reports every fault; the level is that of the worst.
class Troubles {
 public:
  Troubles(Diagnosis& out, const std::string& if_none) : out_(out) { out_.summary(Severity::OK, if_none); }

  void add(bool found, Severity::_level_type level, const std::string& text) {
    if (found) out_.mergeSummary(level, text);
  }

 private:
  Diagnosis& out_;
};

template <class... Values>
std::string format(const char* pattern, Values... values) {
  char text[256];
  std::snprintf(text, sizeof text, pattern, values...);
  return text;
}

}  // namespace

void diagnose_pace(const Health& health, Diagnosis& out) {
  const afm_emulator::EmulatorStatus& status = health.status;
  Troubles troubles(out, status.paused ? "paused" : "running");
  troubles.add(status.lag > kHopelessLag, Severity::ERROR,
               format("%.1f s behind the wall clock: the machine is too slow for this run", status.lag));
  troubles.add(status.lag > kTroublingLag && !(status.lag > kHopelessLag), Severity::WARN,
               format("%.1f s behind the wall clock", status.lag));
  troubles.add(health.lost_batch, Severity::ERROR, "batches were lost: publishing does not keep up");
  troubles.add(
      health.late_share > kTroublingLateShare, Severity::WARN,
      format("%.0f %% of the batches are late (scheduler: %s)", 100.0 * health.late_share, status.scheduler.c_str()));
  out.add("real-time factor", status.real_time_factor);
  out.add("lag [s]", status.lag);
  out.add("worst lag [s]", status.worst_lag);
  out.add("late batches", status.late_batches);
  out.addf("late batches since the last check", "%.1f %%", 100.0 * health.late_share);
  out.add("scheduler", status.scheduler);
  out.add("dropped messages", status.dropped_messages);
}

void diagnose_commands(const Health& health, Diagnosis& out) {
  Troubles troubles(out, "nothing was refused of late");
  troubles.add(!health.refusal.empty(), health.overload ? Severity::ERROR : Severity::WARN,
               "refused: " + health.refusal);
  troubles.add(health.timed_out, Severity::WARN,
               format("the drag was stopped: no command for %g s (command_timeout_s)", health.command_timeout_s));
  out.add("refused drag commands", health.status.refused_commands);
  out.add("refused changes of parameters", health.refused_changes);
  out.add("drag stopped as no command came", health.timed_out);
}

void diagnose_numerics(const Health& health, Diagnosis& out) {
  const afm_emulator::EmulatorStatus& status = health.status;
  Troubles troubles(out, "exact");
  troubles.add(status.search_failures > 0, Severity::ERROR,
               "searches for the next impact have given up: this epoch is not exact");
  troubles.add(status.worst_penetration > kPenetration * health.lattice_spacing_m, Severity::ERROR,
               "the tip was below the surface: this epoch is not exact");
  troubles.add(health.budget_spent, Severity::WARN,
               "batches are cut short by the impact budget: too many impacts for real time");
  out.add("failed impact searches", status.search_failures);
  out.add("worst penetration [m]", status.worst_penetration);
  out.add("batches cut short by the impact budget", status.budget_exhausted);
  out.add("impacts per tau", status.impacts_per_tau);
}

void diagnose_recording(const Health& health, Diagnosis& out) {
  const afm_emulator::EmulatorStatus& status = health.status;
  const bool recording = !status.recording.empty();
  Troubles troubles(out, recording ? "recording" : "not recording");
  troubles.add(!status.recorder_error.empty(), Severity::ERROR, "ended early: " + status.recorder_error);
  troubles.add(recording && health.dropped_from_recording > 0, Severity::ERROR,
               "messages are missing in the recording: the disk is too slow");
  troubles.add(
      health.free_mb >= 0.0 && health.free_mb < kScarceReserves * health.reserve_mb, Severity::WARN,
      format("%.0f MB are free, and recordings end at %.0f MB (disk_reserve_mb)", health.free_mb, health.reserve_mb));
  out.add("bag", status.recording);
  if (health.free_mb >= 0.0) out.addf("free [MB]", "%.0f", health.free_mb);
  out.add("messages missing in the recording", health.dropped_from_recording);
}

}  // namespace afm::node
