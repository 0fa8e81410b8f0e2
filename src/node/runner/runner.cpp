#include "runner.h"

#include <algorithm>
#include <cmath>

#include "scheduling.h"

namespace afm::node {
namespace {

using Kind = Request::Kind;
using Result = Answer::Result;

// More commands than anyone sends within a batch; beyond them a command is refused rather than delayed further.
constexpr std::size_t kMaxWaitingRequests = 1024;
// How soon a stop is noticed while paused without a request, and room for another batch while there is none.
constexpr std::chrono::milliseconds kPausedPoll{100}, kLockstepPoll{10}, kRoomPoll{1};
// A publisher that takes nothing up for so long is stuck.
constexpr std::chrono::seconds kPublishingPatience{1};
// A step that cannot end (an impact that never comes, a chattering tip) ends after this. Whoever asked for it waits
// longer (emulator_node.cpp), and so hears how far it came.
constexpr std::chrono::seconds kStepPatience{8};

}  // namespace

Runner::Runner(const Parameters& parameters, BatchQueue& queue)
    : start_(parameters),
      parameters_(parameters),
      run_(run_settings(parameters)),
      queue_(queue),
      spare_(preallocated_batch(parameters)),
      pacer_(batch_period(parameters), monotonic_now()),
      paused_(parameters.paused),
      lockstep_(parameters.pace == kLockstep),
      requests_(kMaxWaitingRequests) {}

void Runner::start() {
  thread_ = std::thread([this] { loop(); });
  scheduler_ = running_.get_future().get();
}

void Runner::stop() {
  stopping_ = true;
  asked_.post();
  if (thread_.joinable()) thread_.join();
}

bool Runner::submit(const Request& request) {
  const std::lock_guard<std::mutex> lock(submitting_);
  if (!requests_.push(request)) return false;
  asked_.post();
  return true;
}

void Runner::loop() {
  name_thread("afm_run");
  running_.set_value(claim_real_time());
  pacer_.resume(monotonic_now());
  begin_epoch();
  while (!stopping_) {
    wait_for_work();
    serve_requests();
    if (paused_ || stopping_ || (lockstep_ && !may_advance())) continue;
    check_timeout();
    play_commands();
    const Outcome outcome = run_batch(lockstep_, [this](Batch& batch) { return run_.advance(batch); });
    // A batch cut short by its budget is reported, but its period is not over: the rest follows at once, and lag grows.
    if (outcome != Outcome::budget_spent) pacer_.batch_done(monotonic_now());
  }
}

void Runner::wait_for_work() {
  if (paused_ || lockstep_) {
    asked_.wait_for(lockstep_ ? kLockstepPoll : kPausedPoll);
  } else {
    sleep_until(pacer_.deadline());  // at once if that is past: behind, we run as fast as we can
  }
}

bool Runner::may_advance() {
  if (parameters_.wait_for != kCommand) return false;
  const auto now = monotonic_now();
  if (!command_heard_ && now < command_deadline_) return false;
  if (!command_heard_) ++unanswered_batches_;
  command_heard_ = false;
  command_deadline_ = now + std::chrono::nanoseconds(std::llround(parameters_.command_wait_s * 1e9));
  return true;
}

// Behind, as after the process was stopped, we may be faster than the publisher: then lag grows rather than that a batch
// is lost.
Batch* Runner::acquire(bool unhurried) {
  const auto give_up = monotonic_now() + kPublishingPatience;
  for (;;) {
    Batch* batch = queue_.acquire();
    if (batch != nullptr || stopping_ || (!unhurried && monotonic_now() > give_up)) return batch;
    sleep_until(monotonic_now() + kRoomPoll);
  }
}

template <class Advance>
Outcome Runner::run_batch(bool unhurried, Advance advance) {
  Batch* const reported = acquire(unhurried);
  Batch& batch = reported != nullptr ? *reported : spare_;
  const Outcome outcome = advance(batch);
  last_batch_impacts_ = batch.impacts.size();
  measured_.add(batch);
  if (reported == nullptr) ++dropped_batches_;
  Report report = make_report(Report::Kind::batch);
  report.batch = reported;
  report.unhurried = unhurried;
  if (reported != nullptr) queue_.offer(report);  // there is room: requests leave it for all batches
  return outcome;
}

// A request stays in its queue until there is room to report it, so that no accepted command goes unpublished.
void Runner::serve_requests() {
  Request request;
  while (!stopping_ && queue_.has_room_for_request() && requests_.pop(request)) {
    Report report;
    const Answer reply = serve(request);
    if (!request.reply) continue;
    report = make_report(Report::Kind::answer);
    report.answer = reply;
    report.reply = request.reply;
    queue_.offer(report);
  }
}

Answer Runner::serve(const Request& request) {
  Live live = live_of(parameters_);
  switch (request.kind) {
    case Kind::drag:
      timed_out_ = false;
      last_command_ = monotonic_now();
      live.drag_velocity = request.value;
      apply(live, Cause::drag_velocity);
      break;
    case Kind::rest_height:
    case Kind::load:
      live.rest_height_m = request.value;
      apply(live, request.kind == Kind::load ? Cause::load : Cause::rest_height);
      break;
    case Kind::change:
      live = request.live;
      live.drag_velocity = parameters_.drag_velocity;
      apply(live, Cause::parameters);
      break;
    case Kind::pause:
    case Kind::resume:
      pause(request.kind == Kind::pause);
      break;
    case Kind::reset:
      ++epoch_;
      begin_epoch();
      break;
    case Kind::snapshot:
      take_snapshot();
      break;
    case Kind::step_time:
      return step_time(request.value);
    case Kind::step_impacts:
      return step_impacts(request.impacts);
    case Kind::control:
      return control(request);
    case Kind::flush:
      break;
  }
  return answer(Result::done);
}

void Runner::begin_epoch() {
  set_live(live_of(start_), parameters_);
  run_ = Run(run_settings(parameters_));
  last_command_ = monotonic_now();
  timed_out_ = false;
  commands_played_ = 0;
  number_ = 0;
  queue_.offer(make_report(Report::Kind::epoch));
  apply(live_of(parameters_), Cause::epoch);
  take_snapshot();
}

void Runner::apply(const Live& live, Cause cause) {
  set_live(live, parameters_);
  const RunSettings settings = run_settings(parameters_);
  const LevelChoice choice = choose_level(parameters_, settings.model, settings.eta);
  LiveSettings next = live_settings(settings);
  next.level = choice.level;
  level_ = {choice.level, choice.expected_error, run_.apply(next)};
  pacer_.set_period(batch_period(parameters_));
  cause_ = cause;
  command_heard_ = true;
  if (cause != Cause::epoch) ++number_;
  queue_.offer(make_report(Report::Kind::applied));
}

// The scene's list of commands, in model time: so a scene repeats to the last bit.
void Runner::play_commands() {
  const auto& eta = parameters_.commands_eta;
  if (eta.empty() || !queue_.has_room_for_request()) return;
  const double hold = parameters_.commands_hold_s / Units(parameters_.si).time();
  if (run_.now() < multiply(commands_played_, hold)) return;
  Live live = live_of(parameters_);
  live.drag_velocity = eta[commands_played_ % eta.size()] * Units(parameters_.si).velocity();
  ++commands_played_;
  apply(live, Cause::scene);
}

// A stop is a command like any other, applied and reported at a batch boundary: a replay needs no clock.
void Runner::check_timeout() {
  if (parameters_.command_timeout_s == 0.0 || parameters_.drag_velocity == 0.0) return;
  const double silence = std::chrono::duration<double>(monotonic_now() - last_command_).count();
  if (silence < parameters_.command_timeout_s || !queue_.has_room_for_request()) return;
  timed_out_ = true;
  Live live = live_of(parameters_);
  live.drag_velocity = 0.0;
  apply(live, Cause::timeout);
}

// An event that is due now is reported first, in a batch of no length.
void Runner::take_snapshot() {
  while (!run_.can_split() && !stopping_) {
    run_batch(true, [this](Batch& batch) { return run_.advance(run_.now(), parameters_.impact_budget, batch); });
  }
  const Snapshot snapshot = run_.split();
  Report report = make_report(Report::Kind::snapshot);
  report.snapshot = snapshot;
  queue_.offer(report);
}

void Runner::pause(bool paused) {
  if (paused_ && !paused) {
    last_command_ = monotonic_now();
    pacer_.resume(last_command_);
  }
  paused_ = paused;
}

Answer Runner::answer(Result result, std::uint64_t impacts) const {
  Answer answer;
  answer.result = result;
  answer.time = run_.now();
  answer.impacts = impacts;
  return answer;
}

Answer Runner::step_time(double tau) { return is_held() ? advance_by(tau) : answer(Result::not_paused); }

Answer Runner::advance_by(double tau) {
  const ModelTime target = run_.now() + tau;
  const auto give_up = monotonic_now() + kStepPatience;
  std::uint64_t impacts = 0;
  while (run_.now() < target) {
    if (stopping_) return answer(Result::shutting_down, impacts);
    if (monotonic_now() > give_up) return answer(Result::time_ran_out, impacts);
    play_commands();
    run_batch(true, [&](Batch& batch) { return run_.advance(target, parameters_.impact_budget, batch); });
    impacts += last_batch_impacts_;
  }
  return answer(Result::done, impacts);
}

Answer Runner::step_impacts(std::uint64_t wanted) {
  if (!is_held()) return answer(Result::not_paused);
  const ModelTime limit = run_.now() + kMaxStepTau;
  const auto give_up = monotonic_now() + kStepPatience;
  std::uint64_t impacts = 0;
  while (impacts < wanted) {
    if (stopping_) return answer(Result::shutting_down, impacts);
    if (monotonic_now() > give_up || !(run_.now() < limit)) return answer(Result::time_ran_out, impacts);
    play_commands();
    const std::uint64_t most = std::min(wanted - impacts, parameters_.impact_budget);
    run_batch(true, [&](Batch& batch) { return run_.advance(limit, most, batch); });
    impacts += last_batch_impacts_;
  }
  return answer(Result::done, impacts);
}

Answer Runner::control(const Request& request) {
  if (!lockstep_) return answer(Result::not_lockstep);
  Live live = live_of(parameters_);
  const bool drags = !std::isnan(request.live.drag_velocity), lifts = !std::isnan(request.live.rest_height_m);
  if (drags) live.drag_velocity = request.live.drag_velocity;
  if (lifts) live.rest_height_m = request.live.rest_height_m;
  if (drags || lifts) apply(live, drags ? Cause::drag_velocity : Cause::rest_height);
  measured_ = {};
  measured_.begin = run_.now();
  Answer reply = advance_by(request.value);
  reply.measured = measured_;
  reply.epoch = epoch_;
  reply.number = number_;
  reply.drag_velocity = parameters_.drag_velocity;
  return reply;
}

Report Runner::make_report(Report::Kind kind) {
  Report report;
  report.kind = kind;
  report.wall_ns = wall_now_ns();
  report.live = live_of(parameters_);
  report.level = level_;
  report.cause = cause_;
  report.number = number_;
  report.state = state();
  return report;
}

RunnerState Runner::state() {
  // an unfinished batch is late already when its deadline is past
  const double overdue = is_held() ? 0.0 : std::chrono::duration<double>(monotonic_now() - pacer_.deadline()).count();
  RunnerState state;
  state.epoch = epoch_;
  state.time = run_.now();
  state.impacts = run_.impacts();
  state.samples = run_.samples();
  state.real_time_factor = is_held() ? 0.0 : pacer_.real_time_factor();
  state.lag = lockstep_ ? 0.0 : std::max(pacer_.lag(), overdue);
  worst_lag_ = std::max({worst_lag_, state.lag, lockstep_ ? 0.0 : pacer_.worst_lag()});
  state.worst_lag = worst_lag_;
  state.batches = pacer_.batches();
  state.late_batches = pacer_.late_batches();
  state.dropped_batches = dropped_batches_;
  state.counters = run_.counters();
  state.paused = paused_;
  state.unanswered_batches = unanswered_batches_;
  state.timed_out = timed_out_;
  return state;
}

}  // namespace afm::node
