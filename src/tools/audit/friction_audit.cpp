#include "friction_audit.h"

#include <algorithm>
#include <cmath>

#include "node/wire/message_conversion.h"
#include "worst.h"

namespace afm::audit {
namespace {

constexpr std::size_t kStretches = 5;
// Error of the loss of a part of a burst over its energy: what it loses, and m v_n^2 / 2 at its begin, as a weak burst may
// gain as much from the slide as its bounces lose. The law of chatter divides an energy to some per cent.
constexpr double kBurstError = 0.1;

// Relative to the larger; NaN agrees with NaN alone.
double mismatch(double a, double b) {
  if (std::isnan(a) || std::isnan(b)) return std::isnan(a) && std::isnan(b) ? 0.0 : HUGE_VAL;
  return a == b ? 0.0 : std::abs(a - b) / std::max(std::abs(a), std::abs(b));
}

}  // namespace

void FrictionReport::add(const Stretch& stretch) {
  stretches.push_back(stretch);
  std::stable_sort(stretches.begin(), stretches.end(), [](const auto& a, const auto& b) { return a.tau > b.tau; });
  stretches.resize(std::min(stretches.size(), kStretches));
}

void FrictionReport::merge(const FrictionReport& other) {
  estimates += other.estimates;
  miscounted += other.miscounted;
  note(energy_error, other.energy_error);
  note(k_f_error, other.k_f_error);
  for (const Stretch& stretch : other.stretches) add(stretch);
}

FrictionAudit::FrictionAudit(const afm_emulator::Configuration& configuration)
    : units_(node::si_model(configuration)), drag_velocity_(configuration.drag_velocity) {}

void FrictionAudit::command(const ModelTime& time, double drag_velocity) {
  if (drag_velocity == drag_velocity_) return;  // the same again changes nothing
  drag_velocity_ = drag_velocity;
  change(time);
}

void FrictionAudit::change(const ModelTime& time) {
  close_stretch();
  start_ = time;
  sums_ = split_ = {};
  base_ = Sums{};
  awaits_first_ = true;
}

void FrictionAudit::gap() {
  base_.reset();
  sums_ = split_ = {};
  awaits_first_ = true;
}

// The estimate counts of a burst what came after the command that split it; the burst's event counts it whole.
void FrictionAudit::take_split(const afm_emulator::Friction& estimate) {
  const long double before = base_->energy + sums_.energy - estimate.energy_loss;
  const std::uint64_t count = base_->count + sums_.count - estimate.impact_count;
  if (before > -split_error_ && before < split_.energy + split_error_ && count <= split_.count) {
    base_ = Sums{base_->energy - before, base_->count - count};
  }
  split_ = {};
}

void FrictionAudit::add(const afm_emulator::ImpactArray& batch) {
  if (batch.first_index == 0 && start_ == ModelTime{}) base_ = Sums{};
  for (const afm_emulator::Impact& impact : batch.impacts) {
    if (awaits_first_ && impact.kind == afm_emulator::Impact::BURST) {
      const double v_n = impact.normal_speed / units_.velocity();
      split_ = {impact.energy_loss, impact.count};
      split_error_ = kBurstError * (std::abs(impact.energy_loss) + 0.5 * v_n * v_n * units_.energy());
    }
    awaits_first_ = false;
    sums_.energy += impact.energy_loss;
    sums_.count += impact.count;
  }
}

void FrictionAudit::judge(const afm_emulator::Friction& estimate) {
  ++report_.estimates;
  if (!base_) {
    base_ = Sums{static_cast<long double>(estimate.energy_loss) - sums_.energy, estimate.impact_count - sums_.count};
  }
  if (split_.count > 0) take_split(estimate);
  const auto energy = static_cast<double>(base_->energy + sums_.energy);
  if (base_->count + sums_.count != estimate.impact_count) ++report_.miscounted;
  note(report_.energy_error, mismatch(energy, estimate.energy_loss));
  judge_figures(estimate, energy);
}

void FrictionAudit::judge_figures(const afm_emulator::Friction& estimate, double energy) {
  const double age = (node::from_message(estimate.time) - start_) * units_.time();  // [s]
  const double v0 = drag_velocity_;
  const bool moving = v0 != 0.0;
  const double k_f = moving ? energy / (v0 * v0 * age) : std::nan("");
  note(report_.k_f_error, mismatch(estimate.drag_velocity, v0));
  note(report_.k_f_error, mismatch(estimate.eta, v0 / units_.velocity()));
  note(report_.k_f_error, mismatch(estimate.k_f, k_f));
  note(report_.k_f_error, mismatch(estimate.k_f_natural, k_f / units_.friction()));
  note(report_.k_f_error, mismatch(estimate.force, moving ? k_f * v0 : 0.0));
  last_ = Stretch{v0,
                  estimate.eta,
                  age / units_.time(),
                  estimate.k_f_natural,
                  estimate.k_f_std_error / units_.friction(),
                  k_f / units_.friction()};
}

void FrictionAudit::close_stretch() {
  if (last_) report_.add(*last_);
  last_.reset();
}

void FrictionAudit::finish() { close_stretch(); }

}  // namespace afm::audit
