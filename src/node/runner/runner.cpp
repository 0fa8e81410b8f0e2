#include "runner.h"

#include <ros/time.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "node/params/table.h"

namespace afm::node {
namespace {

using Kind = Request::Kind;

// More commands than anyone sends within a batch; beyond them a command is refused rather than delayed further.
constexpr std::size_t kMaxWaitingRequests = 1024;
// How soon a stop is noticed while paused without a request, and room for another batch while there is none.
constexpr std::chrono::milliseconds kPausedPoll{100}, kLockstepPoll{10}, kRoomPoll{1};
// A step that cannot end (an impact that never comes, a chattering tip) ends after this. Whoever asked for it waits
// longer (emulator_node.cpp), and learns how far it came.
constexpr std::chrono::seconds kStepPatience{8};

// [sample periods] Model times are rounded by less than both. A command of the scene is due if its time is less than
// kDueNow ahead, so a run that is advanced in other parts plays it at the same time. A control period is over if less
// than kRounding is left of it. A period or step that ends so near a sample ends there: as whole batches, with no batch
// of a rounding's length behind them.
constexpr double kDueNow = 0.5, kRounding = 1e-3;

constexpr std::uint64_t kNoLimit = std::numeric_limits<std::uint64_t>::max();

}  // namespace

Runner::Runner(const Parameters& parameters, BatchQueue& queue)
    : start_(parameters),
      parameters_(parameters),
      run_(run_settings(parameters)),
      queue_(queue),
      pacer_(batch_period(parameters), monotonic_now()),
      lockstep_(parameters.pace == kLockstep),
      requests_(kMaxWaitingRequests) {
  state_.paused = parameters.paused;
}

void Runner::start() {
  thread_ = std::thread([this] { loop(); });
  scheduler_ = running_.get_future().get();
}

void Runner::stop() {
  stopping_ = true;
  submitted_.post();
  if (thread_.joinable()) thread_.join();
}

bool Runner::submit(const Request& request) {
  const std::lock_guard<std::mutex> lock(submitting_);
  if (!requests_.push(request)) return false;
  submitted_.post();
  return true;
}

void Runner::loop() {
  name_thread("afm_run");
  running_.set_value(claim_real_time());
  begin_epoch();
  while (!stopping_) {
    wait_for_work();
    serve_requests();
    if (state_.paused || stopping_ || (lockstep_ && !may_advance())) continue;
    stop_drag_without_commands();
    play_commands();
    const Outcome outcome = run_batch([this](Batch& batch) { return run_.advance(batch); });
    // A batch cut short by its budget is reported, but its period is not over: the rest follows at once, and lag grows.
    if (outcome != Outcome::budget_spent) pacer_.batch_done(monotonic_now());
  }
}

void Runner::wait_for_work() {
  if (is_held()) {
    submitted_.wait_for(lockstep_ ? kLockstepPoll : kPausedPoll);
  } else {
    sleep_until(pacer_.deadline());  // at once if that is past: behind, we run as fast as we can
  }
}

// In lockstep: a batch for every command, or after the time in which none came since the last was published.
bool Runner::may_advance() {
  if (parameters_.wait_for != kCommand) return false;
  if (!command_came_) {
    if (!queue_.is_published()) {  // nobody can answer what he has not seen
      awaits_command_ = false;
      return false;
    }
    if (!std::exchange(awaits_command_, true)) await_command();
    if (monotonic_now() < command_deadline_) return false;
  }
  command_came_ = awaits_command_ = false;
  return true;
}

void Runner::await_command() {
  command_deadline_ = monotonic_now() + Time(std::llround(parameters_.command_wait_s * 1e9));
}

// A stop is a command like any other, applied and reported at a batch boundary: a replay needs no clock.
void Runner::stop_drag_without_commands() {
  if (parameters_.command_timeout_s == 0.0 || parameters_.drag_velocity == 0.0) return;
  const double silence = std::chrono::duration<double>(monotonic_now() - last_command_).count();
  if (silence < parameters_.command_timeout_s || !queue_.has_room_for_request()) return;
  state_.timed_out = true;
  Live live = parameters_;
  live.drag_velocity = 0.0;
  apply(live, "timeout");
}

ModelTime Runner::time_after(double tau) const {
  const ModelTime end = run_.now() + tau, rounded = run_.sample_grid().rounded(end, kRounding);
  return run_.now() < rounded ? rounded : end;
}

double Runner::samples(double count) const {
  return count / (parameters_.sample_rate_hz * Units(parameters_.si).time());
}

// The scene's list of commands, in model time: so a scene repeats to the last bit.
void Runner::play_commands() {
  const auto& eta = parameters_.commands_eta;
  if (eta.empty()) return;
  const Units units(parameters_.si);
  if (run_.now() + samples(kDueNow) < multiply(commands_played_, parameters_.commands_hold_s / units.time())) return;
  while (!queue_.has_room_for_request() && !stopping_) sleep_until(monotonic_now() + kRoomPoll);
  Live live = parameters_;
  live.drag_velocity = eta[commands_played_ % eta.size()] * units.velocity();
  ++commands_played_;
  apply(live, "scene");
}

// A request stays in its queue until there is room to report it, so that no accepted command goes unpublished.
void Runner::serve_requests() {
  Request request;
  while (!stopping_ && queue_.has_room_for_request() && requests_.pop(request)) {
    const Answer answer = serve(request);
    if (request.reply) offer_answer(answer, std::move(request.reply));
  }
}

Answer Runner::serve(Request& request) {
  switch (request.kind) {
    case Kind::command:
      command(request);
      command_came_ = true;
      break;
    case Kind::change:
      change(request);
      break;
    case Kind::pause:
    case Kind::resume:
      pause(request.kind == Kind::pause);
      break;
    case Kind::reset:
      answer_periods([](const Period&) { return true; }, "reset while it was measured");
      ++state_.epoch;
      begin_epoch();
      break;
    case Kind::snapshot:
      take_snapshot();
      break;
    case Kind::step:
      if (!is_held()) return answer("the emulator is running: pause it first");
      return request.tau > 0.0 ? step(time_after(request.tau), kNoLimit)
                               : step(run_.now() + kMaxStepTau, request.impacts);
    case Kind::control:
      return control(request);
    case Kind::flush:
      break;
  }
  return answer();
}

void Runner::begin_epoch() {
  live_of(parameters_) = start_;
  in_force_.live = start_;
  const RunSettings settings = run_settings(parameters_);
  const LevelChoice choice = choose_level(parameters_, settings);
  in_force_.level = choice.level;
  in_force_.expected_error = choice.expected_error;
  run_ = Run(settings);
  last_command_ = monotonic_now();
  pacer_.resume(last_command_);
  state_.timed_out = false;
  commands_played_ = applied_ = 0;
  command_came_ = true;  // the first batch needs none: whoever listens hears of it
  queue_.offer(make_report(Report::Kind::epoch));
  apply(parameters_, "epoch");
  take_snapshot();
}

void Runner::command(const Request& request) {
  await_command();
  Live live = parameters_;
  if (!std::isnan(request.drag_velocity)) {
    live.drag_velocity = request.drag_velocity;
    last_command_ = monotonic_now();
    state_.timed_out = false;
  }
  if (!std::isnan(request.rest_height)) live.si.rest_height_m = request.rest_height;
  apply(live, request.cause);
}

// What is in force may be another than whoever asked for it knows. The current values change nothing.
void Runner::change(const Request& request) {
  Live live = parameters_;
  bool changes = false;
  for_each_live_pair(request.live, live, [&](double asked, double& value) {
    if (std::isnan(asked) || asked == value) return;
    value = asked;
    changes = true;
  });
  if (changes) apply(live, "parameters");
}

void Runner::apply(const Live& live, const char* cause) {
  live_of(parameters_) = live;
  RunSettings settings = run_settings(parameters_);
  const LevelChoice choice = choose_level(parameters_, settings);
  settings.model.kind = choice.level.kind;
  settings.contact_tolerance = choice.level.contact_tolerance;
  in_force_ = {live, choice.level, choice.expected_error, run_.apply(settings), cause, applied_++};
  for (Period& period : periods_) {
    double& constant = period.measured.drag_velocity;
    if (period.measured.begin == run_.now()) {
      constant = live.drag_velocity;
    } else if (live.drag_velocity != constant) {
      constant = kAsItIs;
    }
  }
  pacer_.set_period(batch_period(parameters_));
  queue_.offer(make_report(Report::Kind::applied));
}

// An event that is due now is reported first, in a batch of no length.
void Runner::take_snapshot() {
  while (!run_.can_split() && !stopping_) run_batch_to(run_.now(), parameters_.impact_budget);
  if (stopping_) return;
  const Snapshot snapshot = run_.split();
  Report report = make_report(Report::Kind::snapshot);
  report.snapshot = snapshot;
  queue_.offer(report);
}

// The time of a pause is no silence of a controller, and no delay.
void Runner::pause(bool paused) {
  if (state_.paused == paused) return;
  state_.paused = paused;
  const Time now = monotonic_now();
  if (paused) {
    paused_at_ = now;
    return;
  }
  last_command_ = std::min(last_command_ + (now - paused_at_), now);
  await_command();
  pacer_.resume(now);
}

// To the limit, or until so many impacts are taken, of which there must then be as many before the limit.
Answer Runner::step(const ModelTime& limit, std::uint64_t impacts) {
  const Time give_up = monotonic_now() + kStepPatience;
  const std::uint64_t before = run_.impacts();
  const auto taken = [&] { return run_.impacts() - before; };
  const char* fault = "";
  play_commands();
  while (run_.now() < limit && taken() < impacts && fault[0] == '\0') {
    run_batch_to(limit, std::min(impacts - taken(), parameters_.impact_budget));
    if (run_.now() + samples(kDueNow) < limit) play_commands();  // at the end they are of what follows
    if (monotonic_now() > give_up) fault = kWallTimeRanOut;
    if (stopping_) fault = "the emulator is shutting down";
  }
  const bool is_done = impacts == kNoLimit ? !(run_.now() < limit) : taken() >= impacts;
  Answer reached = answer(is_done ? "" : fault[0] != '\0' ? fault : kModelTimeRanOut);
  reached.impacts = taken();
  await_command();  // whoever steps it steers it
  return reached;
}

// In lockstep the period is over when this returns. In real time it takes the reply with it, and the clock goes on.
Answer Runner::control(Request& request) {
  const bool takes_time = request.tau > 0.0;
  if (state_.paused && takes_time) return answer("the emulator is paused: resume it first");
  if (periods_.size() == periods_.capacity() && takes_time) {
    static_assert(kMaxPeriods == 8, "the text says so");
    return answer("eight control periods are under way: wait for one, or let ~reset end them");
  }
  play_commands();  // what is due now; the caller's comes after it, and holds
  if (request.cause[0] != '\0') command(request);
  Period period;
  period.measured.begin = run_.now();
  period.measured.drag_velocity = parameters_.drag_velocity;
  period.end = time_after(request.tau);
  if (!takes_time) return answer_of(period, answer());
  periods_.push_back(period);
  if (!lockstep_) {
    periods_.back().reply = std::move(request.reply);
    return answer();
  }
  const Answer reached = step(period.end, kNoLimit);
  const Answer at_end = answer_of(periods_.back(), reached);
  periods_.pop_back();
  return at_end;
}

Answer Runner::answer_of(const Period& period, Answer reached) const {
  reached.measured = period.measured;
  reached.epoch = state_.epoch;
  reached.number = in_force_.number;
  return reached;
}

// Those that are over, in real time.
template <class Condition>
void Runner::answer_periods(Condition is_over, const char* fault) {
  const auto over = std::partition(periods_.begin(), periods_.end(), [&](const Period& p) { return !is_over(p); });
  for (auto period = over; period != periods_.end(); ++period) {
    offer_answer(answer_of(*period, answer(fault)), std::move(period->reply));
  }
  periods_.erase(over, periods_.end());
}

void Runner::offer_answer(const Answer& answer, Reply reply) {
  Report report = make_report(Report::Kind::answer);
  report.answer = answer;
  report.reply = std::move(reply);  // the publisher keeps it until the next report, and so frees it
  queue_.offer(report);
}

Answer Runner::answer(const char* fault) const {
  Answer answer;
  answer.fault = fault;
  answer.time = answer.measured.begin = run_.now();  // nothing was measured
  return answer;
}

void Runner::run_batch_to(const ModelTime& limit, std::uint64_t impacts) {
  run_batch([&](Batch& batch) { return run_.advance(limit, impacts, batch); });
}

// Behind, as after the process was stopped, we may be faster than the publisher: then lag grows rather than that a
// batch is lost.
template <class Advance>
Outcome Runner::run_batch(Advance advance) {
  Batch* batch = queue_.acquire();
  for (; batch == nullptr && !stopping_; batch = queue_.acquire()) sleep_until(monotonic_now() + kRoomPoll);
  if (batch == nullptr) return Outcome::time_limit;
  const Outcome outcome = advance(*batch);
  for (Period& period : periods_) period.measured.add(*batch);
  Report report = make_report(Report::Kind::batch);
  report.batch = batch;
  queue_.offer(report);  // there is room: requests leave it for all batches
  if (!lockstep_) answer_periods([this](const Period& p) { return !(run_.now() + samples(kRounding) < p.end); }, "");
  return outcome;
}

Report Runner::make_report(Report::Kind kind) {
  update_state();
  Report report;
  report.kind = kind;
  report.unhurried = is_held();
  report.wall_ns = ros::WallTime::now().toNSec();
  report.in_force = in_force_;
  report.state = state_;
  return report;
}

void Runner::update_state() {
  state_.time = run_.now();
  state_.impacts = run_.impacts();
  state_.samples = run_.samples();
  state_.counters = run_.counters();
  state_.batches = pacer_.batches();
  state_.real_time_factor = is_held() ? 0.0 : pacer_.real_time_factor();
  if (lockstep_) return;  // an emulator that waits for its controller is never late
  state_.late_batches = pacer_.late_batches();
  // an unfinished batch is late already when its deadline is past
  const double overdue = std::chrono::duration<double>(monotonic_now() - pacer_.deadline()).count();
  state_.lag = state_.paused ? 0.0 : std::max(pacer_.lag(), overdue);
  state_.worst_lag = std::max({state_.worst_lag, state_.lag, pacer_.worst_lag()});
}

}  // namespace afm::node
