#include "broadcaster.h"

#include "arithmetic_digest.h"
#include "diagnosis.h"
#include "node/stepping/scheduling.h"
#include "topics.h"
#include "version.h"

namespace afm::node {
namespace {

constexpr std::chrono::milliseconds kStatusPeriod{100};
constexpr std::chrono::milliseconds kDigestPeriod{1000};
constexpr std::chrono::milliseconds kRequestDeadline{500};
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

Broadcaster::Broadcaster(ros::NodeHandle& node, const Parameters& parameters, Sources sources)
    : parameters_(parameters),
      units_(parameters.si),
      arithmetic_digest_(arithmetic_digest()),
      sources_(std::move(sources)),
      deflection_(node, sources_.recorder, kDeflectionTopic, kBatchQueueSize),
      impacts_(node, sources_.recorder, kImpactsTopic, kBatchQueueSize),
      friction_(node, sources_.recorder, kFrictionTopic, kBatchQueueSize),
      applied_drag_(node, sources_.recorder, kAppliedDragTopic, kCommandQueueSize, true),
      applied_parameters_(node, sources_.recorder, kAppliedParametersTopic, kCommandQueueSize, true),
      status_(node, sources_.recorder, kStatusTopic, kStatusQueueSize),
      configuration_(node, sources_.recorder, kConfigurationTopic, kConfigurationQueueSize, true),
      digest_(node, sources_.recorder, kDigestTopic, kDigestQueueSize),
      checkpoint_(node, sources_.recorder, kCheckpointTopic, kCheckpointQueueSize, true),
      health_tracker_(parameters.si.lattice_spacing_m, parameters.command_timeout_s, parameters.disk_reserve_mb) {
  look_for_listeners();  // a recording from the very first message on
  diagnostics_.setHardwareID("none");
  diagnostics_.add("emulation", [this](Diagnosis& out) { diagnose_pace(health_, out); });
  diagnostics_.add("commands", [this](Diagnosis& out) { diagnose_commands(health_, out); });
  diagnostics_.add("numerics", [this](Diagnosis& out) { diagnose_numerics(health_, out); });
  diagnostics_.add("recording", [this](Diagnosis& out) { diagnose_recording(health_, out); });
}

void Broadcaster::start(const std::string& scheduler) {
  tracker_ = std::make_unique<StatusTracker>(units_, scheduler);
  thread_ = std::thread([this] { run(); });
}

void Broadcaster::stop() {
  stopping_ = true;
  if (thread_.joinable()) thread_.join();
}

void Broadcaster::run() {
  name_thread("afm_publish");
  follow_real_time();  // or on a busy machine chatter comes faster than we would be let to take it, and is lost
  Event event;
  Batch batch = roomy_batch(parameters_);
  SavedState state;
  for (bool last = false; !last;) {
    last = stopping_;  // check once more after the order to stop, so that nothing handed over before is lost
    if (!last) sources_.hand_over.wait_for(kStatusPeriod);
    look_for_listeners();
    while (sources_.hand_over.take(event, batch, state)) {
      publish(event, batch, state);
      look_for_listeners();
      tell_status();
    }
    tell_status();
  }
  tell_digest();
}

void Broadcaster::publish(const Event& event, const Batch& batch, const SavedState& state) {
  const Label label{to_stamp(event.wall_ns), event.state.epoch};
  tracker_->observe(event);
  set_live(event.live, parameters_);
  switch (event.kind) {
    case Event::Kind::reset:
      begin_epoch(label);
      break;
    case Event::Kind::drag_applied:
      send(to_applied_drag(event.state, event.drag_velocity, event.level, units_, label), applied_drag_);
      break;
    case Event::Kind::parameters_applied:
      send(to_applied_parameters(event.state, parameters_, event.level, label), applied_parameters_);
      sources_.applied(event.live);
      break;
    case Event::Kind::batch:
      publish_batch(event, batch, label);
      break;
    case Event::Kind::checkpoint:
      publish_checkpoint(event, state, label);
      break;
    case Event::Kind::answer:
      sources_.deliver(event.answer);
      break;
  }
}

void Broadcaster::begin_epoch(const Label& label) {
  tell_digest();  // of the epoch that ends
  auto configuration = to_configuration(parameters_, kVersion, arithmetic_digest_, label);
  run_digest_ = RunDigest(configuration);
  configuration_.send(std::move(configuration));
}

void Broadcaster::publish_batch(const Event& event, const Batch& batch, const Label& label) {
  // those of an older stretch come too late for whoever wants them now: to them it would seem to have a gap behind it
  if (event.batch.stretch != 0 && event.batch.stretch == sources_.demand.stretch()) {
    send(to_deflection(batch, 1.0 / parameters_.sample_rate_hz, units_, label), deflection_);
  } else {
    deflection_.skip();
    run_digest_.begin_samples(event.state.samples);
  }
  send(to_impacts(batch, units_, label), impacts_);
  send(to_friction(batch, event.drag_velocity, units_, label), friction_);
}

void Broadcaster::publish_checkpoint(const Event& event, const SavedState& state, const Label& label) {
  const CheckpointContext context{label.epoch,
                                  event.state.commands,
                                  applied_drag_.next_sequence(),
                                  applied_parameters_.next_sequence(),
                                  event.drag_velocity,
                                  event.live};
  auto message = to_checkpoint(context, event.state.time, event.state.impacts, event.state.samples, run_digest_, state);
  message.header.stamp = label.stamp;
  checkpoint_.send(std::move(message));
}

template <class Message>
void Broadcaster::send(Message&& message, Channel<Message>& channel) {
  run_digest_.add(message);
  digest_published_ = false;
  channel.send(std::move(message));
}

void Broadcaster::look_for_listeners() {
  const std::lock_guard<std::mutex> lock(listening_);
  sources_.demand.want(recording_expected_ || deflection_.has_subscribers() || sources_.recorder.is_recording());
}

void Broadcaster::expect_recording(bool expected) {
  {
    const std::lock_guard<std::mutex> lock(listening_);
    recording_expected_ = expected;
  }
  look_for_listeners();
}

void Broadcaster::tell_digest() {
  if (digest_published_) return;
  auto message = run_digest_.message();
  message.header.stamp = to_stamp(wall_now_ns());
  digest_.send(std::move(message));
  digest_published_ = true;
}

void Broadcaster::request_digest() {
  std::unique_lock<std::mutex> lock(requests_);
  digest_requested_ = true;
  answered_.wait_for(lock, kRequestDeadline, [this] { return !digest_requested_; });
}

void Broadcaster::answer_request() {
  const std::lock_guard<std::mutex> lock(requests_);
  if (!digest_requested_) return;
  tell_digest();
  digest_requested_ = false;
  answered_.notify_all();
}

void Broadcaster::tell_status() {
  if (is_due(status_due_, kStatusPeriod)) {
    latest_status_ = tracker_->make(sources_.recorder.status(), sources_.refusals.commands());
    status_.send(afm_emulator::EmulatorStatus(latest_status_));
  }
  if (is_due(digest_due_, kDigestPeriod)) tell_digest();
  answer_request();
  if (is_due(diagnostics_due_, kDiagnosticsPeriod)) tell_diagnostics();
}

void Broadcaster::tell_diagnostics() {
  health_ = health_tracker_.look(
      {latest_status_, tracker_->state(), sources_.recorder.status(), sources_.refusals, sources_.disk.free_bytes()},
      std::chrono::steady_clock::now());
  diagnostics_.force_update();
}

}  // namespace afm::node
