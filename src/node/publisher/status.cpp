#include "status.h"

#include "messages.h"

namespace afm::node {
namespace {

constexpr double kMarkTau = 100.0;             // impacts are counted over so long: some hundreds of them
constexpr std::chrono::seconds kRecently{10};  // troubles that come and go are reported for so long

constexpr double kTroublingLag = 0.5;        // [s] a choice: what a person notices
constexpr double kHopelessLag = 2.0;         // [s] a choice
constexpr double kTroublingLateShare = 0.1;  // of the batches since the last check: a choice
constexpr double kPenetration = 1e-10;       // [a]: more is not rounding

using Severity = diagnostic_msgs::DiagnosticStatus;

}  // namespace

StatusTracker::StatusTracker(const Parameters& parameters) : units_(parameters.si) {
  health_.lattice_spacing_m = parameters.si.lattice_spacing_m;
  health_.command_timeout_s = parameters.command_timeout_s;
}

void StatusTracker::observe(const Report& report) {
  state_ = report.state;
  if (report.kind == Report::Kind::epoch) mark_ = state_;
  afm_emulator::EmulatorStatus& status = health_.status;
  status.model = name(report.in_force.level.kind);
  status.contact_tolerance = report.in_force.level.contact_tolerance;
  status.expected_error = report.in_force.expected_error;
}

// Over a hundred tau or more, or since the start of the epoch.
void StatusTracker::count_impacts() {
  const double span = state_.time - mark_.time;
  const bool first = mark_.time == ModelTime{}, full = span >= kMarkTau;
  if (!first && !full) return;
  health_.status.impacts_per_tau = span > 0.0 ? static_cast<double>(state_.impacts - mark_.impacts) / span : 0.0;
  if (full) mark_ = state_;
}

afm_emulator::EmulatorStatus StatusTracker::update_status(const Recorder::Status& recorder,
                                                          const Refusals::Summary& refusals,
                                                          std::uint64_t lost_messages) {
  count_impacts();
  afm_emulator::EmulatorStatus& status = health_.status;
  status.header.stamp.fromNSec(ros::WallTime::now().toNSec());
  status.epoch = state_.epoch;
  status.time = to_message(state_.time);
  status.real_time_factor = state_.real_time_factor;
  status.lag = state_.lag;
  status.worst_lag = state_.worst_lag;
  status.late_batches = state_.late_batches;
  status.budget_exhausted = state_.counters.budget_exhausted;
  status.search_failures = state_.counters.search_failures;
  status.worst_penetration = state_.counters.worst_penetration * units_.length();
  status.paused = state_.paused;
  status.refused_commands = refusals.commands;
  status.dropped_messages = lost_messages + recorder.dropped_messages;
  status.recording = recorder.recording;
  status.recorder_error = recorder.error;
  return status;
}

void StatusTracker::check(const Recorder::Status& recorder, const Refusals::Summary& refusals, Time now) {
  const std::uint64_t batches = state_.batches - checked_.batches, late = state_.late_batches - checked_.late_batches;
  health_.late_share = batches > 0 ? static_cast<double>(late) / static_cast<double>(batches) : 0.0;
  if (state_.counters.budget_exhausted > checked_.counters.budget_exhausted) budget_spent_ = now;
  health_.budget_spent = budget_spent_ != Time::min() && now - budget_spent_ < kRecently;
  checked_ = state_;
  health_.timed_out = state_.timed_out;
  health_.refused_changes = refusals.changes;
  const bool is_recent = now - refusals.when < kRecently;
  health_.refusal = is_recent ? refusals.reason : "";
  health_.overload = is_recent && refusals.kind == Refusal::overload;
  health_.dropped_from_recording = recorder.dropped_from_recording;
}

void diagnose_pace(const Health& health, Diagnosis& out) {
  const afm_emulator::EmulatorStatus& status = health.status;
  out.summary(Severity::OK, status.paused ? "paused" : "running");
  if (status.lag > kHopelessLag) {
    out.mergeSummaryf(Severity::ERROR, "%.1f s behind the wall clock: the machine is too slow for this run",
                      status.lag);
  } else if (status.lag > kTroublingLag) {
    out.mergeSummaryf(Severity::WARN, "%.1f s behind the wall clock", status.lag);
  }
  if (health.late_share > kTroublingLateShare) {
    out.mergeSummaryf(Severity::WARN, "%.0f %% of the batches are late (scheduler: %s)", 100.0 * health.late_share,
                      status.scheduler.c_str());
  }
  out.add("real-time factor", status.real_time_factor);
  out.add("lag [s]", status.lag);
  out.add("worst lag [s]", status.worst_lag);
  out.add("late batches", status.late_batches);
  out.addf("late batches since the last check", "%.1f %%", 100.0 * health.late_share);
  out.add("scheduler", status.scheduler);
  out.add("dropped messages", status.dropped_messages);
}

void diagnose_commands(const Health& health, Diagnosis& out) {
  out.summary(Severity::OK, "nothing was refused of late");
  if (!health.refusal.empty()) {
    out.mergeSummary(health.overload ? Severity::ERROR : Severity::WARN, "refused: " + health.refusal);
  }
  if (health.timed_out) {
    out.mergeSummaryf(Severity::WARN, "the drag was stopped: no drag velocity for %g s (command_timeout_s)",
                      health.command_timeout_s);
  }
  out.add("refused commands", health.status.refused_commands);
  out.add("refused changes of parameters", health.refused_changes);
  out.add("drag stopped as no drag velocity came", health.timed_out);
}

void diagnose_numerics(const Health& health, Diagnosis& out) {
  const afm_emulator::EmulatorStatus& status = health.status;
  out.summary(Severity::OK, "exact");
  if (status.search_failures > 0) {
    out.mergeSummary(Severity::ERROR, "searches for the next impact have failed: this epoch is not exact");
  }
  if (status.worst_penetration > kPenetration * health.lattice_spacing_m) {
    out.mergeSummary(Severity::ERROR, "the tip was below the surface: this epoch is not exact");
  }
  if (health.budget_spent) {
    out.mergeSummary(Severity::WARN, "batches are cut short by the impact budget: too many impacts for real time");
  }
  out.add("failed impact searches", status.search_failures);
  out.add("worst penetration [m]", status.worst_penetration);
  out.add("batches cut short by the impact budget", status.budget_exhausted);
  out.add("impacts per tau", status.impacts_per_tau);
}

void diagnose_recording(const Health& health, Diagnosis& out) {
  const afm_emulator::EmulatorStatus& status = health.status;
  const bool recording = !status.recording.empty();
  out.summary(Severity::OK, recording ? "recording" : "not recording");
  if (!status.recorder_error.empty()) out.mergeSummary(Severity::ERROR, "ended early: " + status.recorder_error);
  if (recording && health.dropped_from_recording > 0) {
    out.mergeSummary(Severity::ERROR, "messages are missing in the recording: the disk is too slow");
  }
  out.add("bag", status.recording);
  out.add("messages missing in the recording", health.dropped_from_recording);
}

}  // namespace afm::node
