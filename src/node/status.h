// The status message and what diagnostics say of it.
#pragma once

#include <afm_emulator/EmulatorStatus.h>
#include <diagnostic_updater/diagnostic_updater.h>

#include <atomic>
#include <cstdint>
#include <string>

#include "afm_emulator/units.h"
#include "events.h"
#include "message_conversion.h"
#include "recorder.h"

namespace afm::node {

// Gathers the status from those who know a part of it. Used by the publishing thread alone.
class StatusTracker {
 public:
  StatusTracker(const Units& units, std::string model, std::string scheduler)
      : units_(units), model_(std::move(model)), scheduler_(std::move(scheduler)) {}

  void observe(const Event& event);
  afm_emulator::EmulatorStatus make(const Recorder::Status& recorder, std::uint64_t refused_commands);

 private:
  double impacts_per_tau() const;
  void move_mark();

  const Units units_;
  const std::string model_, scheduler_;
  StepperState state_;
  std::uint64_t impacts_ = 0;  // of this epoch
  // impacts per tau are counted from a mark that follows behind
  ModelTime mark_time_;
  std::uint64_t mark_impacts_ = 0;
  double impacts_per_tau_ = 0.0;
};

// For diagnostic_updater: OK, or what is wrong in words, and the figures.
void diagnose_emulation(const afm_emulator::EmulatorStatus& status, diagnostic_updater::DiagnosticStatusWrapper& out);
void diagnose_recording(const afm_emulator::EmulatorStatus& status, diagnostic_updater::DiagnosticStatusWrapper& out);

}  // namespace afm::node
