// The publisher's thread: takes what the running thread reports, publishes and records it, and reports the status.
#pragma once

#include <diagnostic_updater/diagnostic_updater.h>
#include <ros/node_handle.h>
#include <rosgraph_msgs/Clock.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <functional>
#include <string>
#include <thread>

#include "afm/fingerprint.h"
#include "channel.h"
#include "messages.h"
#include "node/recorder/recorder.h"
#include "node/runner/report.h"
#include "node/runner/threads.h"
#include "status.h"
#include "topics.h"

namespace afm::node {

class Publisher {
 public:
  struct Sources {
    BatchQueue& queue;
    Recorder& recorder;
    const Refusals& refusals;
    std::function<void(const Live&)> on_applied;  // called with what has taken effect
  };

  Publisher(ros::NodeHandle& node, const Parameters& parameters, Sources sources)
      : parameters_(parameters),
        units_(parameters.si),
        fingerprint_(arithmetic_fingerprint()),
        sources_(std::move(sources)),
        configuration_(node, sources_.recorder, kConfigurationTopic, kLatchedQueueSize, Role::configuration),
        applied_(node, sources_.recorder, kAppliedTopic, kCommandQueueSize, Role::applied),
        snapshot_(node, sources_.recorder, "snapshot", kLatchedQueueSize, Role::snapshot),
        deflection_(node, sources_.recorder, kDeflectionTopic, kBatchQueueSize, Role::batch),
        impacts_(node, sources_.recorder, kImpactsTopic, kBatchQueueSize, Role::batch),
        friction_(node, sources_.recorder, kFrictionTopic, kBatchQueueSize, Role::batch_end),
        status_(node, sources_.recorder, "status", kStatusQueueSize),
        status_tracker_(parameters) {
    if (parameters.publish_clock) {
      ros::AdvertiseOptions options;
      options.init<rosgraph_msgs::Clock>("/clock", kBatchQueueSize);
      options.connect_cb = [this](const auto&) { somebody_lacks_the_clock_ = true; };
      options.callback_queue = &at_once_;
      clock_ = node.advertise(options);
    }
    diagnostics_.setHardwareID("none");
    diagnostics_.add("emulation", [this](Diagnosis& out) { diagnose_pace(status_tracker_.health(), out); });
    diagnostics_.add("commands", [this](Diagnosis& out) { diagnose_commands(status_tracker_.health(), out); });
    diagnostics_.add("numerics", [this](Diagnosis& out) { diagnose_numerics(status_tracker_.health(), out); });
    diagnostics_.add("recording", [this](Diagnosis& out) { diagnose_recording(status_tracker_.health(), out); });
  }

  ~Publisher() { stop(); }

  void start(const std::string& scheduler) {
    status_tracker_.set_scheduler(scheduler);
    thread_ = std::thread([this] { run(); });
  }

  // After all that was reported is published.
  void stop() {
    stopping_ = true;
    if (thread_.joinable()) thread_.join();
  }

 private:
  static constexpr std::chrono::milliseconds kStatusPeriod{100};
  static constexpr std::chrono::milliseconds kDiagnosticsPeriod{1000};  // as diagnostic aggregators expect

  void run() {
    name_thread("afm_publish");
    follow_real_time();  // or on a busy machine chatter comes faster than we would be let to take it, and is lost
    Report report;
    for (bool last = false; !last;) {
      last = stopping_;  // check once more after the order to stop, so that nothing reported before is lost
      if (!last) sources_.queue.wait_for(kStatusPeriod);
      while (sources_.queue.take(report)) {
        publish(report);
        publish_status();
      }
      publish_status();
    }
  }

  void publish(Report& report) {
    if (report.kind == Report::Kind::epoch && !latest_clock_.isZero())
      epoch_begin_ = latest_clock_ + ros::Duration(0, 1);
    const Label label{stamp_of(report), report.state.epoch};
    status_tracker_.observe(report);
    unhurried_ = report.unhurried;
    live_of(parameters_) = report.in_force.live;
    // nobody who is slow holds up the end; the recording is made whole
    const bool for_subscribers = report.unhurried && !stopping_;
    const auto send = [&](auto& channel, auto&& message) {
      channel.send(std::forward<decltype(message)>(message), for_subscribers, report.unhurried);
    };
    switch (report.kind) {
      case Report::Kind::epoch:
        latest_configuration_ = to_configuration(parameters_, AFM_EMULATOR_VERSION, fingerprint_, label);
        send(configuration_, latest_configuration_);
        break;
      case Report::Kind::applied:
        latest_applied_ = to_applied(report, parameters_, label);
        send(applied_, latest_applied_);
        sources_.on_applied(report.in_force.live);
        break;
      case Report::Kind::snapshot:
        send(snapshot_, to_snapshot(report.snapshot, latest_configuration_, latest_applied_, label));
        break;
      case Report::Kind::batch:
        send(deflection_, to_deflection(*report.batch, report.in_force.live, units_, label));
        send(impacts_, to_impacts(*report.batch, units_, label));
        send(friction_, to_friction(*report.batch, report.in_force.live, units_, label));
        sources_.queue.release(report.batch);
        break;
      case Report::Kind::answer:
        return report.reply->set_value(report.answer);
    }
    // after what belongs to this time: whoever wakes by the clock finds it there
    if (clock_ && label.stamp > latest_clock_) publish_clock(label.stamp);
  }

  // The stamp is wall time, or model time if the emulator publishes the clock.
  ros::Time stamp_of(const Report& report) const {
    ros::Time stamp;
    if (!clock_) return stamp.fromNSec(report.wall_ns);
    const ModelTime& t = report.state.time;
    const double seconds = static_cast<double>(t.tau) * units_.time() + t.phase * units_.time();
    return stamp.fromNSec(epoch_begin_.toNSec() + static_cast<std::uint64_t>(std::llround(seconds * 1e9)));
  }

  // Strictly rising, and never 0.
  void publish_clock(const ros::Time& now) {
    rosgraph_msgs::Clock message;
    message.clock = latest_clock_ = now;
    clock_.publish(message);
  }

  // While time stands still, whoever is new gets the time too, a nanosecond on. All that follows is as much later: a
  // rospy.Rate that began then is over when its batch is. Not latched: roscpp sends what is latched at once, and then
  // what it published before, so that the clock of a new subscriber could go back.
  void publish_clock_to_new_subscribers() {
    if (!somebody_lacks_the_clock_.exchange(false) || latest_clock_.isZero()) return;
    const ros::Duration step(0, 1);
    epoch_begin_ += step;
    publish_clock(latest_clock_ + step);
  }

  void publish_status() {
    publish_clock_to_new_subscribers();
    if (is_due(status_due_, kStatusPeriod)) {
      afm_emulator::EmulatorStatus status =
          status_tracker_.update_status(sources_.recorder.status(), sources_.refusals.summary(),
                                        deflection_.lost() + impacts_.lost() + friction_.lost());
      if (clock_) status.header.stamp = latest_clock_;
      status_.send(std::move(status), false, unhurried_);
    }
    if (is_due(diagnostics_due_, kDiagnosticsPeriod)) {
      status_tracker_.check(sources_.recorder.status(), sources_.refusals.summary(), std::chrono::steady_clock::now());
      diagnostics_.force_update();
    }
  }

  // Due at whole periods, so that the rate is right whenever we check; periods that went by are not made up for.
  static bool is_due(std::chrono::steady_clock::time_point& due, std::chrono::milliseconds period) {
    const auto now = std::chrono::steady_clock::now();
    if (now < due) return false;
    due += period;
    if (due < now) due = now + period;
    return true;
  }

  Parameters parameters_;  // as they are at the report that is published
  const Units units_;
  const std::string fingerprint_;
  Sources sources_;
  // roscpp sends what waits in this order: what was applied goes before the batch in which it holds
  Channel<afm_emulator::Configuration> configuration_;
  Channel<afm_emulator::Applied> applied_;
  Channel<afm_emulator::Snapshot> snapshot_;
  Channel<afm_emulator::Deflection> deflection_;
  Channel<afm_emulator::ImpactArray> impacts_;
  Channel<afm_emulator::Friction> friction_;
  Channel<afm_emulator::EmulatorStatus> status_;
  afm_emulator::Configuration latest_configuration_;
  afm_emulator::Applied latest_applied_;
  bool unhurried_ = false;  // the latest report: a status may fall out of a recording no more than a batch
  // model time, if it is to be published: it goes on where the epoch before ended
  AtOnce at_once_;
  std::atomic<bool> somebody_lacks_the_clock_{false};
  ros::Publisher clock_;
  ros::Time epoch_begin_{1, 0}, latest_clock_;
  diagnostic_updater::Updater diagnostics_;
  StatusTracker status_tracker_;
  std::chrono::steady_clock::time_point status_due_, diagnostics_due_;
  std::atomic<bool> stopping_{false};
  std::thread thread_;
};

}  // namespace afm::node
