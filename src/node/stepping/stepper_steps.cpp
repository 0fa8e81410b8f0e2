// Steps while paused: by a time or to an impact, as fast as they are taken up, with nothing dropped.
#include "scheduling.h"
#include "step_limits.h"
#include "stepper.h"

namespace afm::node {
namespace {

// A step that cannot end (an impact that never comes, a chattering tip) is given up after this; who asked for it waits
// longer (control.cpp), and so hears how far it came.
constexpr std::chrono::seconds kPatience{8};

}  // namespace

bool Stepper::hand_over_step() {
  const Event report = batch_event();
  while (!hand_over_.offer(report, batch_)) {
    if (stopping_) return false;
    sleep_until(monotonic_now() + kRoomLook);
  }
  return !stopping_;
}

Answer Stepper::answer(Answer::Result result, std::uint64_t impacts) const {
  Answer answer;
  answer.result = result;
  answer.impacts = impacts;
  return answer;
}

Answer Stepper::step_time(double tau) {
  if (!paused_) return answer(Answer::Result::not_paused, 0);
  const EmulatorSettings& settings = emulator_.settings();
  const double batch_tau = static_cast<double>(settings.samples_per_batch) * settings.sample_period;
  const ModelTime target = emulator_.now() + tau;
  const auto give_up = monotonic_now() + kPatience;
  std::uint64_t impacts = 0;
  while (emulator_.now() < target && monotonic_now() < give_up) {
    look_for_demand();
    // the last part crosses one batch boundary at most
    target - emulator_.now() > batch_tau ? emulator_.run_batch(batch_) : emulator_.run_until(target, batch_);
    impacts += batch_.impacts.size();
    if (!hand_over_step()) return answer(Answer::Result::shutting_down, impacts);
  }
  const bool reached = !(emulator_.now() < target);
  return answer(reached ? Answer::Result::done : Answer::Result::time_ran_out, impacts);
}

Answer Stepper::step_impacts(std::uint64_t wanted) {
  if (!paused_) return answer(Answer::Result::not_paused, 0);
  const ModelTime limit = emulator_.now() + kMaxStepTau;
  const auto give_up = monotonic_now() + kPatience;
  std::uint64_t impacts = 0;
  while (impacts < wanted && emulator_.now() < limit && monotonic_now() < give_up) {
    look_for_demand();
    emulator_.run_impacts(wanted - impacts, batch_);
    impacts += batch_.impacts.size();
    if (!hand_over_step()) return answer(Answer::Result::shutting_down, impacts);
  }
  return answer(impacts == wanted ? Answer::Result::done : Answer::Result::time_ran_out, impacts);
}

}  // namespace afm::node
