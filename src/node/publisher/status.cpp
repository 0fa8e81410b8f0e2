#include "status.h"

#include "node/runner/scheduling.h"

namespace afm::node {
namespace {

constexpr double kMarkTau = 100.0;              // impacts are counted over so long: some hundreds of them
constexpr std::uint64_t kMessagesPerBatch = 3;  // deflection, impacts, friction

}  // namespace

void StatusTracker::observe(const Report& report) {
  state_ = report.state;
  level_ = report.level;
  if (report.kind == Report::Kind::epoch) {
    mark_impacts_ = 0;
    mark_time_ = {};
    impacts_per_tau_ = 0.0;
  }
}

double StatusTracker::impacts_per_tau() const {
  const double span = state_.time - mark_time_;
  return span > 0.0 ? static_cast<double>(state_.impacts - mark_impacts_) / span : 0.0;
}

// Until the mark has first moved, the rate is counted from the start of the epoch.
void StatusTracker::move_mark() {
  const bool first = mark_time_ == ModelTime{};
  const bool full = state_.time - mark_time_ >= kMarkTau;
  if (first || full) impacts_per_tau_ = impacts_per_tau();
  if (!full) return;
  mark_time_ = state_.time;
  mark_impacts_ = state_.impacts;
}

afm_emulator::EmulatorStatus StatusTracker::make(const Recorder::Status& recorder, std::uint64_t refused_commands,
                                                 std::uint64_t lost_messages) {
  move_mark();
  ros::Time stamp;
  const Label label{stamp.fromNSec(static_cast<std::uint64_t>(wall_now_ns())), state_.epoch};
  auto message = to_status(state_, units_, label);
  message.impacts_per_tau = impacts_per_tau_;
  message.refused_commands = refused_commands;
  message.dropped_messages = state_.dropped_batches * kMessagesPerBatch + lost_messages + recorder.dropped_messages;
  message.model = name(level_.level.kind);
  message.contact_tolerance = level_.level.contact_tolerance;
  message.expected_error = level_.expected_error;
  message.scheduler = scheduler_;
  message.recording = recorder.recording;
  message.recorder_error = recorder.error;
  return message;
}

}  // namespace afm::node
