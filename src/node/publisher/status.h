// The status message.
#pragma once

#include <afm_emulator/EmulatorStatus.h>

#include <cstdint>
#include <string>

#include "afm/units.h"
#include "messages.h"
#include "node/recorder/recorder.h"

namespace afm::node {

// Gathers the status from those who know a part of it. Used by the publisher alone.
class StatusTracker {
 public:
  explicit StatusTracker(const Units& units) : units_(units) {}
  void set_scheduler(const std::string& scheduler) { scheduler_ = scheduler; }

  void observe(const Report& report);
  const RunnerState& state() const { return state_; }
  afm_emulator::EmulatorStatus make(const Recorder::Status& recorder, std::uint64_t refused_commands,
                                    std::uint64_t lost_messages);

 private:
  double impacts_per_tau() const;
  void move_mark();

  const Units units_;
  std::string scheduler_;
  RunnerState state_;
  AppliedLevel level_;
  // impacts per tau are counted from a mark that follows behind
  ModelTime mark_time_;
  std::uint64_t mark_impacts_ = 0;
  double impacts_per_tau_ = 0.0;
};

}  // namespace afm::node
