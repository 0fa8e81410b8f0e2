#include "publisher.h"

#include <rosgraph_msgs/Clock.h>

#include <cmath>

#include "afm/fingerprint.h"
#include "node/runner/threads.h"
#include "topics.h"

namespace afm::node {
namespace {

constexpr std::chrono::milliseconds kStatusPeriod{100};
constexpr std::chrono::milliseconds kDiagnosticsPeriod{1000};  // as diagnostic aggregators expect

// Due at whole periods, so that the rate is right whenever we check; periods that went by are not made up for.
bool is_due(std::chrono::steady_clock::time_point& due, std::chrono::milliseconds period) {
  const auto now = std::chrono::steady_clock::now();
  if (now < due) return false;
  due += period;
  if (due < now) due = now + period;
  return true;
}

}  // namespace

Publisher::Publisher(ros::NodeHandle& node, const Parameters& parameters, Sources sources)
    : parameters_(parameters),
      units_(parameters.si),
      fingerprint_(arithmetic_fingerprint()),
      sources_(std::move(sources)),
      deflection_(node, sources_.recorder, kDeflectionTopic, kBatchQueueSize),
      impacts_(node, sources_.recorder, kImpactsTopic, kBatchQueueSize),
      friction_(node, sources_.recorder, kFrictionTopic, kBatchQueueSize),
      status_(node, sources_.recorder, "status", kStatusQueueSize),
      configuration_(node, sources_.recorder, kConfigurationTopic, kLatchedQueueSize, Role::configuration),
      applied_(node, sources_.recorder, kAppliedTopic, kCommandQueueSize, Role::applied),
      snapshot_(node, sources_.recorder, "snapshot", kLatchedQueueSize, Role::snapshot),
      status_tracker_(parameters) {
  if (parameters.publish_clock) clock_ = node.advertise<rosgraph_msgs::Clock>("/clock", kBatchQueueSize);
  diagnostics_.setHardwareID("none");
  diagnostics_.add("emulation", [this](Diagnosis& out) { diagnose_pace(status_tracker_.health(), out); });
  diagnostics_.add("commands", [this](Diagnosis& out) { diagnose_commands(status_tracker_.health(), out); });
  diagnostics_.add("numerics", [this](Diagnosis& out) { diagnose_numerics(status_tracker_.health(), out); });
  diagnostics_.add("recording", [this](Diagnosis& out) { diagnose_recording(status_tracker_.health(), out); });
}

void Publisher::start(const std::string& scheduler) {
  status_tracker_.set_scheduler(scheduler);
  thread_ = std::thread([this] { run(); });
}

void Publisher::stop() {
  stopping_ = true;
  if (thread_.joinable()) thread_.join();
}

void Publisher::run() {
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

void Publisher::publish(Report& report) {
  if (report.kind == Report::Kind::epoch && !latest_clock_.isZero()) epoch_begin_ = latest_clock_ + ros::Duration(0, 1);
  const Label label{stamp_of(report), report.state.epoch};
  status_tracker_.observe(report);
  live_of(parameters_) = report.in_force.live;
  switch (report.kind) {
    case Report::Kind::epoch:
      latest_configuration_ = to_configuration(parameters_, AFM_EMULATOR_VERSION, fingerprint_, label);
      configuration_.send(latest_configuration_);
      break;
    case Report::Kind::applied:
      latest_applied_ = to_applied(report, parameters_, label);
      applied_.send(latest_applied_);
      sources_.on_applied(report.in_force.live);
      break;
    case Report::Kind::snapshot:
      snapshot_.send(to_snapshot(report.snapshot, latest_configuration_, latest_applied_, label));
      break;
    case Report::Kind::batch:
      deflection_.send(to_deflection(*report.batch, report.in_force.live, units_, label), report.unhurried);
      impacts_.send(to_impacts(*report.batch, units_, label), report.unhurried);
      friction_.send(to_friction(*report.batch, report.in_force.live, units_, label), report.unhurried);
      sources_.queue.release(report.batch);
      break;
    case Report::Kind::answer:
      return report.reply->set_value(report.answer);
  }
  // after what belongs to this time: whoever wakes by the clock finds it there
  if (clock_ && label.stamp > latest_clock_) publish_clock(label.stamp);
}

// Of wall time, or where the emulator publishes the clock, of the clock: model time.
ros::Time Publisher::stamp_of(const Report& report) const {
  ros::Time stamp;
  if (!clock_) return stamp.fromNSec(static_cast<std::uint64_t>(report.wall_ns));
  const ModelTime& t = report.state.time;
  const double seconds = static_cast<double>(t.tau) * units_.time() + t.phase * units_.time();
  return stamp.fromNSec(epoch_begin_.toNSec() + static_cast<std::uint64_t>(std::llround(seconds * 1e9)));
}

// Strictly rising, and never 0.
void Publisher::publish_clock(const ros::Time& now) {
  rosgraph_msgs::Clock message;
  message.clock = latest_clock_ = now;
  clock_.publish(message);
}

// While time stands still, whoever is new gets the time too. Not latched: roscpp sends what is latched at once, and then
// what it published before, so that the clock of a new subscriber could go back.
void Publisher::publish_clock_to_new_subscribers() {
  const std::uint32_t subscribers = clock_ ? clock_.getNumSubscribers() : 0;
  if (subscribers > clock_subscribers_ && !latest_clock_.isZero()) publish_clock(latest_clock_ + ros::Duration(0, 1));
  clock_subscribers_ = subscribers;
}

void Publisher::publish_status() {
  publish_clock_to_new_subscribers();
  if (is_due(status_due_, kStatusPeriod)) {
    status_.send(status_tracker_.update_status(sources_.recorder.status(), sources_.refusals.summary(),
                                               deflection_.lost() + impacts_.lost() + friction_.lost()));
  }
  if (is_due(diagnostics_due_, kDiagnosticsPeriod)) {
    status_tracker_.check(sources_.recorder.status(), sources_.refusals.summary(), sources_.free_bytes,
                          std::chrono::steady_clock::now());
    diagnostics_.force_update();
  }
}

}  // namespace afm::node
