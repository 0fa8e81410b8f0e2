// The publisher's thread: takes what the running thread reports, publishes and records it, and reports the status.
#pragma once

#include <diagnostic_updater/diagnostic_updater.h>
#include <ros/node_handle.h>
#include <ros/publisher.h>

#include <atomic>
#include <chrono>
#include <functional>
#include <string>
#include <thread>

#include "channel.h"
#include "messages.h"
#include "node/recorder/recorder.h"
#include "node/runner/batch_queue.h"
#include "refusals.h"
#include "status.h"

namespace afm::node {

class Publisher {
 public:
  struct Sources {
    BatchQueue& queue;
    Recorder& recorder;
    const Refusals& refusals;
    const std::atomic<std::int64_t>& free_bytes;
    std::function<void(const Live&)> on_applied;  // called with what has taken effect
  };

  Publisher(ros::NodeHandle& node, const Parameters& parameters, Sources sources);
  ~Publisher() { stop(); }

  void start(const std::string& scheduler);
  void stop();  // after all that was reported is published

 private:
  void run();
  void publish(Report& report);
  void publish_batch(const Report& report, const Label& label);
  void publish_clock(const ros::Time& now);
  void publish_clock_to_new_subscribers();
  ros::Time stamp_of(const Report& report) const;
  void publish_status();

  Parameters parameters_;  // as they are at the report that is published
  const Units units_;
  const std::string fingerprint_;
  Sources sources_;
  Channel<afm_emulator::Deflection> deflection_;
  Channel<afm_emulator::ImpactArray> impacts_;
  Channel<afm_emulator::Friction> friction_;
  Channel<afm_emulator::EmulatorStatus> status_;
  Channel<afm_emulator::Configuration> configuration_;
  Channel<afm_emulator::Applied> applied_;
  Channel<afm_emulator::Snapshot> snapshot_;
  afm_emulator::Configuration latest_configuration_;
  afm_emulator::Applied latest_applied_;
  // model time, if it is to be published: it goes on where the epoch before ended
  ros::Publisher clock_;
  ros::Time epoch_begin_{1, 0}, latest_clock_;
  std::uint32_t clock_subscribers_ = 0;
  diagnostic_updater::Updater diagnostics_;
  StatusTracker status_tracker_;
  std::chrono::steady_clock::time_point status_due_, diagnostics_due_;
  std::atomic<bool> stopping_{false};
  std::thread thread_;
};

}  // namespace afm::node
