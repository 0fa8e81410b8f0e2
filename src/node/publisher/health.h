// What diagnostics judge: the state of everything that can go wrong, as plain values.
#pragma once

#include <afm_emulator/EmulatorStatus.h>

#include <chrono>
#include <cstdint>
#include <string>

#include "node/recorder/recorder.h"
#include "node/runner/report.h"
#include "refusals.h"

namespace afm::node {

// Troubles that come and go count for so long after they were last seen.
constexpr std::chrono::seconds kRecently{10};

struct Health {
  afm_emulator::EmulatorStatus status;
  // pace
  double late_share = 0.0;   // of the batches since the last check
  bool lost_batch = false;   // recently: emulated, but not published
  // commands
  std::uint64_t refused_changes = 0;
  std::string refusal;       // the latest, if recent
  bool overload = false;     // it was refused as too many were waiting
  bool timed_out = false;    // the drag was stopped as no command came
  double command_timeout_s = 0.0;
  // numerics
  bool budget_spent = false;  // recently
  double lattice_spacing_m = 0.0;
  // recording
  double free_mb = -1.0;  // on the disk recorded to; negative: unknown
  double reserve_mb = 0.0;
  std::uint64_t dropped_from_recording = 0;
};

// Whether a count has risen lately. Counts may begin again at 0.
class RecentRise {
 public:
  using Time = std::chrono::steady_clock::time_point;
  bool update(std::uint64_t count, Time now) {
    if (count > last_) {
      last_rise_ = now;
      risen_ = true;
    }
    last_ = count;
    return risen_ && now - last_rise_ < kRecently;
  }

 private:
  std::uint64_t last_ = 0;
  bool risen_ = false;
  Time last_rise_;
};

// Follows what changes from one check to the next. Used by the publisher alone.
class HealthTracker {
 public:
  struct Sources {
    const afm_emulator::EmulatorStatus& status;
    const RunnerState& runner;
    const Recorder::Status& recorder;
    const Refusals& refusals;
    std::int64_t free_bytes;  // negative: unknown
  };

  HealthTracker(double lattice_spacing_m, double command_timeout_s, double reserve_mb);
  Health update(const Sources& sources, RecentRise::Time now);

 private:
  Health unchanging_;
  std::uint64_t batches_ = 0, late_ = 0;
  RecentRise lost_, budget_;
};

}  // namespace afm::node
