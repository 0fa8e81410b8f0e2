#include "stepper.h"

#include <algorithm>
#include <cmath>

#include "scheduling.h"

namespace afm::node {
namespace {

// More commands than anyone sends within a batch; beyond them a command is refused rather than delayed further.
constexpr std::size_t kMaxWaitingRequests = 1024;
// While paused: how soon a stop is noticed without a request.
constexpr std::chrono::milliseconds kPausedLook{100};

// A publishing thread that takes nothing up for so long is stuck.
constexpr std::chrono::seconds kPublishingPatience{1};

}  // namespace

Stepper::Stepper(const Parameters& parameters, HandOver& hand_over, const SampleDemand& demand)
    : parameters_(parameters),
      emulator_(emulator_settings(parameters)),
      batch_(roomy_batch(parameters)),
      hand_over_(hand_over),
      demand_(demand),
      pacer_(batch_period(parameters), monotonic_now()),
      drag_velocity_(parameters.drag_velocity),
      level_{full_level(parameters)},
      requests_(kMaxWaitingRequests) {}

void Stepper::start() {
  thread_ = std::thread([this] { run(); });
  scheduler_ = running_.get_future().get();
}

void Stepper::stop() {
  stopping_ = true;
  asked_.post();
  if (thread_.joinable()) thread_.join();
}

bool Stepper::submit(const Request& request) {
  const std::lock_guard<std::mutex> lock(submitting_);
  if (!requests_.push(request)) return false;
  asked_.post();
  return true;
}

void Stepper::run() {
  name_thread("afm_step");
  running_.set_value(claim_real_time());
  last_command_ = monotonic_now();
  pacer_.resume(last_command_);
  publish_start();
  while (!stopping_) {
    wait_for_work();
    serve_requests();
    watch_for_commands();
    if (!paused_ && !stopping_) run_batch();
    look_for_checkpoint();
  }
}

void Stepper::wait_for_work() {
  if (paused_) {
    asked_.wait_for(kPausedLook);
  } else {
    sleep_until(pacer_.deadline());  // at once if that is past: behind, we run as fast as we can
  }
}

void Stepper::run_batch() {
  // A batch cut short by its budget is reported, but its period is not over: the rest follows at once, and lag grows.
  look_for_demand();
  const Outcome outcome = emulator_.run_batch(batch_);
  if (outcome != Outcome::budget_spent) pacer_.batch_done(monotonic_now());
  if (!hand_over_batch()) ++dropped_batches_;
}

// Behind, as after the process was stopped, we may be faster than publishing: then lag grows rather than that a batch
// is lost.
bool Stepper::hand_over_batch() {
  const Event report = batch_event();
  const auto give_up = monotonic_now() + kPublishingPatience;
  while (!hand_over_.offer(report, batch_)) {
    if (stopping_ || monotonic_now() > give_up) return false;
    sleep_until(monotonic_now() + kRoomLook);
  }
  return true;
}

void Stepper::look_for_demand() {
  stretch_ = demand_.stretch();
  emulator_.take_samples(stretch_ != 0);
}

Event Stepper::batch_event() {
  Event report = event(Event::Kind::batch);
  report.batch.stretch = stretch_;
  return report;
}

void Stepper::publish(Event::Kind kind, const Answer& answer) {
  Event report = event(kind);
  report.answer = answer;
  hand_over_.offer(report);
}

Event Stepper::event(Event::Kind kind) {
  Event event;
  event.kind = kind;
  event.wall_ns = wall_now_ns();
  event.drag_velocity = drag_velocity_;
  event.live = live_parameters(parameters_);
  event.level = level_;
  event.state = state();
  return event;
}

StepperState Stepper::state() {
  // an unfinished batch is late already when its deadline is past
  const double overdue = paused_ ? 0.0 : std::chrono::duration<double>(monotonic_now() - pacer_.deadline()).count();
  StepperState state;
  state.epoch = epoch_;
  state.time = emulator_.now();
  state.impacts = batch_.first_impact + batch_.impacts.size();
  state.samples = emulator_.samples();
  state.commands = commands_;
  state.real_time_factor = paused_ ? 0.0 : pacer_.real_time_factor();
  state.lag = std::max(pacer_.lag(), overdue);
  worst_lag_ = std::max({worst_lag_, pacer_.worst_lag(), overdue});
  state.worst_lag = worst_lag_;
  state.batches = pacer_.batches();
  state.late_batches = pacer_.late_batches();
  state.dropped_batches = dropped_batches_;
  state.counters = emulator_.counters();
  state.paused = paused_;
  state.timed_out = timed_out_;
  return state;
}

}  // namespace afm::node
