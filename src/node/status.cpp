#include "status.h"

#include "scheduling.h"

namespace afm::node {
namespace {

constexpr double kMarkTau = 100.0;              // impacts are counted over so long: some hundreds of them
constexpr double kTroublingLag = 0.5;           // [s]: what a person notices
constexpr std::uint64_t kMessagesPerBatch = 3;  // deflection, impacts, friction

using Level = diagnostic_msgs::DiagnosticStatus;

std::string trouble(const afm_emulator::EmulatorStatus& status) {
  if (status.lag > kTroublingLag) return "behind the wall clock: the machine is too slow for these rates";
  if (status.search_failures > 0) return "impact searches have failed";
  if (status.dropped_messages > 0) return "messages were dropped";
  if (status.budget_exhausted > 0) return "batches were cut short by the impact budget";
  return {};
}

}  // namespace

void StatusTracker::observe(const Event& event) {
  state_ = event.state;
  if (event.kind == Event::Kind::reset) {
    impacts_ = mark_impacts_ = 0;
    mark_time_ = {};
    impacts_per_tau_ = 0.0;
  }
  if (event.kind == Event::Kind::batch) impacts_ = event.batch.first_impact + event.batch.impacts;
}

double StatusTracker::impacts_per_tau() const {
  const double span = state_.time - mark_time_;
  return span > 0.0 ? static_cast<double>(impacts_ - mark_impacts_) / span : 0.0;
}

// Until the mark has first moved, the rate is counted from the start of the epoch.
void StatusTracker::move_mark() {
  const bool first = mark_time_ == ModelTime{};
  const bool full = state_.time - mark_time_ >= kMarkTau;
  if (first || full) impacts_per_tau_ = impacts_per_tau();
  if (!full) return;
  mark_time_ = state_.time;
  mark_impacts_ = impacts_;
}

afm_emulator::EmulatorStatus StatusTracker::make(const Recorder::Status& recorder, std::uint64_t refused_commands) {
  move_mark();
  const Label label{to_stamp(wall_now_ns()), state_.epoch};
  auto message = to_status(state_, units_, label);
  message.impacts_per_tau = impacts_per_tau_;
  message.refused_commands = refused_commands;
  message.dropped_messages = state_.dropped_batches * kMessagesPerBatch + recorder.dropped_messages;
  message.model = model_;
  message.scheduler = scheduler_;
  message.recording = recorder.recording;
  message.recorder_error = recorder.error;
  return message;
}

void diagnose_emulation(const afm_emulator::EmulatorStatus& status, diagnostic_updater::DiagnosticStatusWrapper& out) {
  const std::string wrong = trouble(status);
  if (wrong.empty()) {
    out.summary(Level::OK, status.paused ? "paused" : "running");
  } else {
    out.summary(Level::WARN, wrong);
  }
  out.add("real-time factor", status.real_time_factor);
  out.add("lag [s]", status.lag);
  out.add("worst lag [s]", status.worst_lag);
  out.add("late batches", status.late_batches);
  out.add("impacts per tau", status.impacts_per_tau);
  out.add("refused commands", status.refused_commands);
  out.add("batches cut short by the impact budget", status.budget_exhausted);
  out.add("failed impact searches", status.search_failures);
  out.add("dropped messages", status.dropped_messages);
  out.add("worst penetration [m]", status.worst_penetration);
  out.add("scheduler", status.scheduler);
}

void diagnose_recording(const afm_emulator::EmulatorStatus& status, diagnostic_updater::DiagnosticStatusWrapper& out) {
  if (!status.recorder_error.empty()) {
    out.summary(Level::ERROR, status.recorder_error);
  } else {
    out.summary(Level::OK, status.recording.empty() ? "not recording" : "recording");
  }
  out.add("bag", status.recording);
  out.add("dropped messages", status.dropped_messages);
}

}  // namespace afm::node
