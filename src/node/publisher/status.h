// How the emulator is doing: the message on ~status, and what /diagnostics report. docs/interface.md has their levels.
#pragma once

#include <afm_emulator/EmulatorStatus.h>
#include <diagnostic_updater/DiagnosticStatusWrapper.h>

#include <chrono>
#include <cstdint>
#include <mutex>
#include <string>

#include "node/params/parameters.h"
#include "node/recorder/recorder.h"
#include "node/runner/report.h"

namespace afm::node {

// Refused commands and parameters, with the reason: counted, and the latest kept. Any thread.
enum class Refusal { faulty_command, overload, faulty_change };

class Refusals {
 public:
  struct Summary {
    std::uint64_t commands = 0, changes = 0;
    // the latest
    Refusal kind = Refusal::faulty_command;
    std::string reason;  // empty: nothing was refused
    std::chrono::steady_clock::time_point when;
  };

  // True once a second: a flood is not logged whole. By the clock of the wall, as that of ROS may stand still.
  bool add(Refusal kind, const std::string& reason) {
    const std::lock_guard<std::mutex> lock(mutex_);
    ++(kind == Refusal::faulty_change ? summary_.changes : summary_.commands);
    summary_.kind = kind;
    summary_.reason = reason;
    summary_.when = std::chrono::steady_clock::now();
    if (summary_.when - logged_ < std::chrono::seconds(1)) return false;
    logged_ = summary_.when;
    return true;
  }
  Summary summary() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return summary_;
  }

 private:
  mutable std::mutex mutex_;
  Summary summary_;
  std::chrono::steady_clock::time_point logged_;
};

// The state that diagnostics judge.
struct Health {
  afm_emulator::EmulatorStatus status;
  double late_share = 0.0;    // of the batches since the last check
  bool budget_spent = false;  // recently
  bool timed_out = false;     // the drag was stopped as no drag velocity came
  double command_timeout_s = 0.0;
  std::string refusal;    // the latest, if recent
  bool overload = false;  // it was refused as too many were waiting
  std::uint64_t refused_changes = 0;
  double lattice_spacing_m = 0.0;
  std::uint64_t dropped_from_recording = 0;
};

// Each reports OK, or what is wrong and why, and the figures.
using Diagnosis = diagnostic_updater::DiagnosticStatusWrapper;
void diagnose_pace(const Health& health, Diagnosis& out);
void diagnose_commands(const Health& health, Diagnosis& out);
void diagnose_numerics(const Health& health, Diagnosis& out);
void diagnose_recording(const Health& health, Diagnosis& out);

// Gathers it from those who know a part of it. Used by the publisher's thread alone.
class StatusTracker {
 public:
  using Time = std::chrono::steady_clock::time_point;

  explicit StatusTracker(const Parameters& parameters);
  void set_scheduler(const std::string& scheduler) { health_.status.scheduler = scheduler; }

  void observe(const Report& report);
  afm_emulator::EmulatorStatus update_status(const Recorder::Status& recorder, const Refusals::Summary& refusals,
                                             std::uint64_t lost_messages);
  // With the latest status.
  void check(const Recorder::Status& recorder, const Refusals::Summary& refusals, Time now);
  const Health& health() const { return health_; }

 private:
  void count_impacts();

  const Units units_;
  Health health_;
  RunnerState state_;
  RunnerState mark_;     // follows behind: impacts per tau are counted from it
  RunnerState checked_;  // at the last check
  Time budget_spent_ = Time::min();
};

}  // namespace afm::node
