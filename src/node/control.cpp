#include "control.h"

#include <chrono>
#include <cmath>
#include <sstream>

#include "node/stepping/step_limits.h"

namespace afm::node {
namespace {

// A batch takes at most 1.5 s, and a step fails after 8 s.
constexpr std::chrono::seconds kDeadline{12};

std::string to_text(const Answer& answer, const std::string& done) {
  switch (answer.result) {
    case Answer::Result::done:
      return done;
    case Answer::Result::not_paused:
      return "the emulator is running: pause it first";
    case Answer::Result::shutting_down:
      return "the emulator is shutting down";
    case Answer::Result::time_ran_out:
      break;
  }
  return "gave up after " + std::to_string(answer.impacts) + " impacts, at the time given";
}

std::string find_fault(double tau, std::uint32_t impacts) {
  std::ostringstream text;
  if (!std::isfinite(tau) || tau < 0.0 || tau > kMaxStepTau) {
    text << "tau = " << tau << ": must be between 0 and " << kMaxStepTau;
  } else if (impacts > kMaxStepImpacts) {
    text << "impacts = " << impacts << ": must be at most " << kMaxStepImpacts;
  } else if ((tau > 0.0) == (impacts > 0)) {
    text << "tau = " << tau << ", impacts = " << impacts << ": exactly one of them must be given, the other 0";
  }
  return text.str();
}

}  // namespace

ControlReply Control::pause(bool paused) {
  Request request;
  request.kind = paused ? Request::Kind::pause : Request::Kind::resume;
  return ask(request, paused ? "paused" : "running");
}

ControlReply Control::reset() {
  Request request;
  request.kind = Request::Kind::reset;
  return ask(request, "model time 0, initial state, new epoch");
}

ControlReply Control::change(const LiveParameters& live) {
  Request request;
  request.kind = Request::Kind::change;
  request.live = live;
  return ask(request, "changed");
}

ControlReply Control::catch_up() {
  Request request;
  request.kind = Request::Kind::nothing;
  return ask(request, "published");
}

ControlReply Control::step(double tau, std::uint32_t impacts) {
  const std::string fault = find_fault(tau, impacts);
  if (!fault.empty()) return {false, fault, {}};
  Request request;
  request.kind = impacts > 0 ? Request::Kind::step_impacts : Request::Kind::step_time;
  request.value = tau;
  request.impacts = impacts;
  return ask(request, impacts > 0 ? "impact reached" : "time reached");
}

ControlReply Control::ask(Request request, const std::string& done) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    request.ticket = ++last_ticket_;
    waiting_[request.ticket] = std::nullopt;
  }
  const bool taken = stepper_.submit(request);
  const auto answer = taken ? wait_for(request.ticket) : std::nullopt;
  const std::lock_guard<std::mutex> lock(mutex_);
  waiting_.erase(request.ticket);
  if (!taken) return {false, "too many requests are waiting", {}};
  if (!answer) return {false, "no answer from the stepping thread in time; it may still come to it", {}};
  return {answer->result == Answer::Result::done, to_text(*answer, done), answer->time};
}

std::optional<Answer> Control::wait_for(std::uint64_t ticket) {
  std::unique_lock<std::mutex> lock(mutex_);
  const auto& answer = waiting_.at(ticket);
  delivered_.wait_for(lock, kDeadline, [&] { return answer.has_value() || closed_; });
  if (answer || !closed_) return answer;
  Answer end;
  end.result = Answer::Result::shutting_down;
  return end;
}

void Control::close() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    closed_ = true;
  }
  delivered_.notify_all();
}

void Control::deliver(const Answer& answer) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    const auto asker = waiting_.find(answer.ticket);
    if (asker == waiting_.end()) return;
    asker->second = answer;
  }
  delivered_.notify_all();
}

}  // namespace afm::node
