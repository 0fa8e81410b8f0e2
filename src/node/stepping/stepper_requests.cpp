// What the stepping thread does between batches: obeys, and stops the drag where nobody commands any more.
#include "scheduling.h"
#include "stepper.h"

namespace afm::node {
namespace {

// So many commands at most are to be remembered, and simulated again, beside the checkpoint before them: half a MB.
constexpr std::uint64_t kMostCommandsBetweenCheckpoints = 2000;

}  // namespace

// A request stays in its queue until there is room to report it, so that no accepted command goes unpublished.
void Stepper::serve_requests() {
  Request request;
  while (!stopping_ && keep_few_to_remember() && hand_over_.has_room_for_request() && requests_.pop(request)) {
    serve(request);
  }
}

// Otherwise a checkpoint takes the next room there is: requests would take it again and again.
bool Stepper::keep_few_to_remember() {
  return commands_since_saved_ < kMostCommandsBetweenCheckpoints || take_checkpoint();
}

void Stepper::serve(const Request& request) {
  Answer reply = answer(Answer::Result::done, 0);
  switch (request.kind) {
    case Request::Kind::drag:
      timed_out_ = false;
      last_command_ = monotonic_now();
      apply_drag(request.value);
      break;
    case Request::Kind::rest_height:
      lift(request.value);
      break;
    case Request::Kind::change:
      apply_change(request.live);
      break;
    case Request::Kind::pause:
      pause(true);
      break;
    case Request::Kind::resume:
      pause(false);
      break;
    case Request::Kind::reset:
      reset();
      break;
    case Request::Kind::step_time:
      reply = step_time(request.value);
      break;
    case Request::Kind::step_impacts:
      reply = step_impacts(request.impacts);
      break;
    case Request::Kind::nothing:
      break;
  }
  reply.ticket = request.ticket;
  reply.time = emulator_.now();
  if (reply.ticket != 0) publish(Event::Kind::answer, reply);
}

void Stepper::apply_drag(double drag_velocity) {
  drag_velocity_ = drag_velocity;
  const double eta = to_eta(drag_velocity, parameters_.si);
  take_level(eta);
  emulator_.drag(eta);
  publish(Event::Kind::drag_applied);
  ++commands_;
  ++commands_since_saved_;
}

// The other parameters as they are now, whatever else was asked for meanwhile.
void Stepper::lift(double rest_height) {
  LiveParameters live = live_parameters(parameters_);
  live.rest_height_m = rest_height;
  apply_change(live);
}

void Stepper::apply_change(const LiveParameters& live) {
  set_live(live, parameters_);
  emulator_.change(live_settings(emulator_settings(parameters_)));
  take_level(emulator_.eta());
  pacer_.set_period(batch_period(parameters_));
  publish(Event::Kind::parameters_applied);
  ++commands_since_saved_;
}

// Before the drag velocity or after the parameters that it is for: who simulates the run again does it in the same
// order.
void Stepper::take_level(double eta) {
  const LevelChoice choice = choose_level(parameters_, emulator_.settings().model, eta);
  level_ = {choice.level, choice.expected_error, emulator_.set_level(choice.level)};
}

// A stop is a command like any other, applied and reported at a batch boundary: who simulates the run again needs no
// clock.
void Stepper::watch_for_commands() {
  if (parameters_.command_timeout_s == 0.0 || drag_velocity_ == 0.0 || paused_) return;
  const double silence = std::chrono::duration<double>(monotonic_now() - last_command_).count();
  if (silence < parameters_.command_timeout_s || !hand_over_.has_room_for_request()) return;
  timed_out_ = true;
  apply_drag(0.0);
}

void Stepper::pause(bool paused) {
  if (paused_ && !paused) {
    last_command_ = monotonic_now();
    pacer_.resume(last_command_);
  }
  paused_ = paused;
}

void Stepper::reset() {
  emulator_.set_level(full_level(parameters_));  // from which every epoch begins
  emulator_.reset();
  batch_.first_impact = 0;
  batch_.impacts.clear();
  drag_velocity_ = parameters_.drag_velocity;
  last_command_ = monotonic_now();
  timed_out_ = false;
  ++epoch_;
  publish_start();
}

void Stepper::publish_start() {
  commands_ = 0;
  publish(Event::Kind::reset);
  take_level(emulator_.eta());
  publish(Event::Kind::drag_applied);
  level_.energy_dropped = 0.0;
  ++commands_;
  publish(Event::Kind::parameters_applied);
  checkpoint_due_ = {};  // at once: the last one is of another epoch
  commands_since_saved_ = 1;
}

// While nothing happens the last one will do.
void Stepper::look_for_checkpoint() {
  const bool anew = commands_since_saved_ > 0 || !(emulator_.now() == saved_time_);
  if (anew && monotonic_now() >= checkpoint_due_) take_checkpoint();
}

// If there is no room to report it, the next check takes it.
bool Stepper::take_checkpoint() {
  emulator_.save(saved_);
  if (!hand_over_.offer(event(Event::Kind::checkpoint), saved_)) return false;
  commands_since_saved_ = 0;
  saved_time_ = emulator_.now();
  checkpoint_due_ = monotonic_now() + checkpoint_interval(parameters_);
  return true;
}

}  // namespace afm::node
