#include "friction_audit.h"

#include <algorithm>
#include <cmath>

#include "afm/tip.h"
#include "node/wire/message_conversion.h"
#include "worst.h"

namespace afm::audit {
namespace {

constexpr std::size_t kStretches = 5;
// Error of the loss of a part of a burst, over what the burst loses and the energy of the fastest bounce that may begin
// one: the error of the law of chatter depends on its fastest bounces, also where its first is slow. Measured in 16,000
// runs of random commands, as in friction_audit_test: at most 0.007.
constexpr double kBurstError = 0.05;

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
    : units_(node::si_model(configuration)), drag_velocity_(configuration.drag_velocity) {
  set_tolerance(configuration.contact_tolerance);
}

void FrictionAudit::set_tolerance(double contact_tolerance) {
  const double v = chatter_entry_speed(contact_tolerance);
  fastest_burst_ = 0.5 * v * v * units_.energy();
}

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
  const long double least = std::min(0.0L, split_.energy), most = std::max(0.0L, split_.energy);
  const long double error = kBurstError * (std::abs(split_.energy) + fastest_burst_);
  if (before > least - error && before < most + error && count <= split_.count) {
    base_ = Sums{base_->energy - before, base_->count - count};
  }
  split_ = {};
}

void FrictionAudit::add(const afm_emulator::ImpactArray& batch) {
  if (batch.first_index == 0 && start_ == ModelTime{}) base_ = Sums{};
  for (const afm_emulator::Impact& impact : batch.impacts) {
    if (awaits_first_ && impact.kind == afm_emulator::Impact::BURST) split_ = {impact.energy_loss, impact.count};
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
