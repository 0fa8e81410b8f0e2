// The publishing thread: takes what the stepping thread hands over, publishes and records it, and reports the status.
#pragma once

#include <diagnostic_updater/diagnostic_updater.h>
#include <ros/node_handle.h>

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <mutex>
#include <string>
#include <thread>

#include "channel.h"
#include "checkpoint_message.h"
#include "node/recording/disk_space.h"
#include "node/stepping/hand_over.h"
#include "health.h"
#include "message_conversion.h"
#include "node/parameters/parameters.h"
#include "node/recording/recorder.h"
#include "node/refusals.h"
#include "run_digest.h"
#include "node/stepping/sample_demand.h"
#include "status.h"

namespace afm::node {

class Broadcaster {
 public:
  struct Sources {
    HandOver& hand_over;
    Recorder& recorder;
    const Refusals& refusals;
    const DiskSpace& disk;
    SampleDemand& demand;
    std::function<void(const Answer&)> deliver;  // answers to requests, each after all that it answers for
    std::function<void(const LiveParameters&)> applied;  // of parameters that have taken effect
  };

  Broadcaster(ros::NodeHandle& node, const Parameters& parameters, Sources sources);
  ~Broadcaster() { stop(); }

  void start(const std::string& scheduler);
  void stop();  // after all that is handed over is published
  // Publishes a digest of all so far; returns when that is done, or after some time when it is not.
  void request_digest();
  // Whether samples are wanted now. Any thread; this one reads it at every batch.
  void look_for_listeners();
  void expect_recording(bool expected);  // samples are wanted for one that is about to begin

 private:
  void run();
  void publish(const Event& event, const Batch& batch, const SavedState& state);
  void begin_epoch(const Label& label);
  void publish_batch(const Event& event, const Batch& batch, const Label& label);
  void publish_checkpoint(const Event& event, const SavedState& state, const Label& label);
  template <class Message>
  void send(Message&& message, Channel<Message>& channel);
  void tell_status();
  void tell_diagnostics();
  void tell_digest();
  void answer_request();

  Parameters parameters_;  // as they are at the event that is reported
  const Units units_;
  const std::string arithmetic_digest_;
  Sources sources_;
  Channel<afm_emulator::Deflection> deflection_;
  Channel<afm_emulator::ImpactArray> impacts_;
  Channel<afm_emulator::Friction> friction_;
  Channel<afm_emulator::AppliedDrag> applied_drag_;
  Channel<afm_emulator::AppliedParameters> applied_parameters_;
  Channel<afm_emulator::EmulatorStatus> status_;
  Channel<afm_emulator::Configuration> configuration_;
  Channel<afm_emulator::Digest> digest_;
  Channel<afm_emulator::Checkpoint> checkpoint_;
  diagnostic_updater::Updater diagnostics_;
  std::unique_ptr<StatusTracker> tracker_;
  afm_emulator::EmulatorStatus latest_status_;
  HealthTracker health_tracker_;
  Health health_;
  RunDigest run_digest_;  // of all that is published
  bool digest_published_ = true;
  std::chrono::steady_clock::time_point status_due_, digest_due_, diagnostics_due_;
  std::mutex listening_;
  bool recording_expected_ = false;
  std::mutex requests_;
  std::condition_variable answered_;
  bool digest_requested_ = false;
  std::atomic<bool> stopping_{false};
  std::thread thread_;
};

}  // namespace afm::node
