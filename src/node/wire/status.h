// The status message.
#pragma once

#include <afm_emulator/EmulatorStatus.h>

#include <cstdint>
#include <string>

#include "afm/units.h"
#include "node/stepping/events.h"
#include "message_conversion.h"
#include "node/recording/recorder.h"

namespace afm::node {

// Gathers the status from those who know a part of it. Used by the publishing thread alone.
class StatusTracker {
 public:
  StatusTracker(const Units& units, std::string scheduler) : units_(units), scheduler_(std::move(scheduler)) {}

  void observe(const Event& event);
  const StepperState& state() const { return state_; }
  afm_emulator::EmulatorStatus make(const Recorder::Status& recorder, std::uint64_t refused_commands);

 private:
  double impacts_per_tau() const;
  void move_mark();

  const Units units_;
  const std::string scheduler_;
  StepperState state_;
  AppliedLevel level_;
  std::uint64_t impacts_ = 0;  // of this epoch
  // impacts per tau are counted from a mark that follows behind
  ModelTime mark_time_;
  std::uint64_t mark_impacts_ = 0;
  double impacts_per_tau_ = 0.0;
};

}  // namespace afm::node
