// The publishing thread: takes what the stepping thread hands over, publishes and records it, and tells how it goes.
#pragma once

#include <diagnostic_updater/diagnostic_updater.h>
#include <ros/node_handle.h>

#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <string>
#include <thread>

#include "channel.h"
#include "hand_over.h"
#include "message_conversion.h"
#include "parameters.h"
#include "recorder.h"
#include "status.h"

namespace afm::node {

class Broadcaster {
 public:
  struct Sources {
    HandOver& hand_over;
    Recorder& recorder;
    const std::atomic<std::uint64_t>& refused_commands;
    std::function<void(const Answer&)> deliver;  // answers to requests, each after all that it answers for
  };

  Broadcaster(ros::NodeHandle& node, const Parameters& parameters, Sources sources);
  ~Broadcaster() { stop(); }

  void start(const std::string& scheduler);
  void stop();  // after all that is handed over is published

 private:
  void run();
  void publish(const Event& event, const Batch& batch);
  void publish_batch(const Event& event, const Batch& batch, const Label& label);
  void tell_status();

  const Parameters parameters_;
  const Units units_;
  const std::string digest_;
  Sources sources_;
  Channel<afm_emulator::Deflection> deflection_;
  Channel<afm_emulator::ImpactArray> impacts_;
  Channel<afm_emulator::Friction> friction_;
  Channel<afm_emulator::AppliedDrag> applied_drag_;
  Channel<afm_emulator::EmulatorStatus> status_;
  Channel<afm_emulator::Configuration> configuration_;
  diagnostic_updater::Updater diagnostics_;
  std::unique_ptr<StatusTracker> tracker_;
  afm_emulator::EmulatorStatus latest_status_;
  std::chrono::steady_clock::time_point status_due_, diagnostics_due_;
  std::atomic<bool> stopping_{false};
  std::thread thread_;
};

}  // namespace afm::node
