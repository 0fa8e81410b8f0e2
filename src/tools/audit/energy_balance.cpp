// The energy balance of a run, from one estimate of friction to another.
#include <algorithm>
#include <cmath>

#include "energy_audit.h"
#include "node/wire/message_conversion.h"
#include "worst.h"

namespace afm::audit {

void EnergyAudit::add(const afm_emulator::Friction& estimate, const ModelTime& since) {
  const ModelTime time = node::from_message(estimate.time);
  const double K_f = estimate.eta == 0.0 ? 0.0 : estimate.k_f_work / units_.friction();
  const double work = K_f * estimate.eta * estimate.eta * (time - since), loss = estimate.energy_loss / units_.energy(),
               heat = estimate.heat_to_bath / units_.energy();
  estimates_.push_back({time, since, work - loss - heat, std::abs(work) + loss + std::abs(heat)});
}

// Between two events that follow each other. Not at the very time of the first: a command may have jolted the hammer.
void EnergyAudit::judge_estimates(const Event& before, const Event& after) {
  const bool flies = flies_between(before, after);
  for (; !estimates_.empty() && estimates_.front().time < after.time; estimates_.pop_front()) {
    const Estimate& estimate = estimates_.front();
    if (!flies || !(before.time < estimate.time) || conditioning_ > 100.0) continue;
    const std::uint64_t last = last_sample_before(estimate.time);
    for (const std::uint64_t first : {last - 1, last}) {
      if (!is_heard(first) || !is_heard(first + 1)) continue;
      if (grid_.time(first) < before.time || after.time < grid_.time(first + 1)) continue;
      judge_balance(estimate, motion(first, estimate.time), after.eta);
      break;
    }
  }
}

bool EnergyAudit::is_heard(std::uint64_t sample) const {
  return sample >= first_sample_ && sample < first_sample_ + samples_.size();
}

// Chatter and contact are reported when they end or begin; kicks and commands in between do not say which it is.
bool EnergyAudit::flies_between(const Event& before, const Event& after) {
  if (before.impact) {
    last_kind_ = before.impact->kind;
    knows_last_ = true;
  }
  const auto from = std::find_if(events_.begin(), events_.end(), [&](const Event& e) { return &e == &after; });
  const auto next = std::find_if(from, events_.end(), [](const Event& e) { return e.impact.has_value(); });
  return knows_last_ && last_kind_ != afm_emulator::Impact::CONTACT_BEGUN && next != events_.end() &&
         next->impact->kind == afm_emulator::Impact::IMPACT;
}

void EnergyAudit::judge_balance(const Estimate& estimate, const Motion& m, double eta) {
  const double stored = energy(m) + eta * m.U + 0.5 * eta * eta;  // in the lab
  if (!base_ || !(base_->since == estimate.since)) {
    base_ = Balance{estimate.since, estimate.given, stored};
    return;
  }
  const double surface = 0.5 * std::pow(omega_[1] * model_.H, 2);
  note(report_.work_error, (estimate.given - base_->given - (stored - base_->stored)) /
                               (estimate.scale + stored + base_->stored + surface));
  ++report_.balanced;
}

}  // namespace afm::audit
