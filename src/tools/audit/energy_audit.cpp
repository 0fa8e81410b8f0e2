#include "energy_audit.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "flight_pair.h"
#include "node/parameters/parameters.h"
#include "node/wire/message_conversion.h"
#include "worst.h"

namespace afm::audit {
namespace {

constexpr double kTooNearlyBlind = 100.0;  // amplification beyond which samples do not determine velocities
// Errors add up along sample, unit conversion, sine, and sum: a few dozen roundings, squared amplification.
constexpr double kRoundings = 64.0 * std::numeric_limits<double>::epsilon();

constexpr double kMostSamples = 1e15;  // of a run: at a million a second thirty years

double square(double x) { return x * x; }

}  // namespace

void EnergyReport::merge(const EnergyReport& other) {
  events += other.events;
  judged += other.judged;
  by_law += other.by_law;
  energy += other.energy;
  judged_energy += other.judged_energy;
  allowed = std::max(allowed, other.allowed);
  note(balance_error, other.balance_error);
  note(position_error, other.position_error);
  note(speed_error, other.speed_error);
  note(law_error, other.law_error);
  balanced += other.balanced;
  note(work_error, other.work_error);
}

EnergyAudit::EnergyAudit(const afm_emulator::Configuration& configuration)
    : units_(node::si_model(configuration)),
      model_(node::emulator_settings(configuration).model),
      grid_{configuration.sample_period_tau, 0, {}},
      omega_{kTwoPi * model_.frequency_ratio, kTwoPi},
      conditioning_(conditioning()),
      eta_(node::to_eta(configuration.drag_velocity, node::si_model(configuration))) {}

double EnergyAudit::conditioning() const {
  return std::max(amplification(omega_[0], grid_.period), amplification(omega_[1], grid_.period));
}

void EnergyAudit::change(const Model& model, const SampleGrid& grid) {
  gap();
  model_ = model;
  grid_ = grid;
  conditioning_ = conditioning();
}

void EnergyAudit::add(const afm_emulator::Deflection& batch) {
  if (samples_.empty()) first_sample_ = batch.first_sample;
  for (std::size_t i = 0; i < batch.vertical.size() && i < batch.lateral.size(); ++i) {
    samples_.push_back({batch.lateral[i] / units_.length(), batch.vertical[i] / units_.length()});
  }
}

void EnergyAudit::add(const afm_emulator::ImpactArray& batch) {
  for (const afm_emulator::Impact& impact : batch.impacts) {
    push({node::from_message(impact.time), impact, eta_});
    report_.energy += impact.energy_loss;
    ++report_.events;
    judge_law(impact);
  }
}

// With the kicks before it.
void EnergyAudit::push(const Event& event) {
  for (; kicks_.next() <= event.time; kicks_.draw()) events_.push_back({kicks_.next(), std::nullopt, eta_});
  events_.push_back(event);
}

void EnergyAudit::add_command(const ModelTime& time, double drag_velocity) {
  push({time, std::nullopt, eta_});
  eta_ = drag_velocity / units_.velocity();
}

void EnergyAudit::gap() {
  events_.clear();
  samples_.clear();
  estimates_.clear();
  base_.reset();
  knows_last_ = false;
}

// dE = (1 - gamma_eff^2) v^2 / 2, with the restitution rising towards 1 below the cutoff. A bounce that would be slower
// than kMinGapRate is none: it loses all that came in.
void EnergyAudit::judge_law(const afm_emulator::Impact& impact) {
  if (impact.kind != afm_emulator::Impact::IMPACT) return;
  const double v = impact.normal_speed / units_.velocity();
  const double gamma = v >= model_.v_c ? model_.gamma : 1.0 - (1.0 - model_.gamma) * v / model_.v_c;
  const double expected = 0.5 * (1.0 - gamma) * (1.0 + gamma) * v * v;
  const double published = impact.energy_loss / units_.energy();
  // near 1 the restitution loses digits: judge against the energy that came in
  const double came_in = 0.5 * v * v, slow = 2.0 * kMinGapRate;
  // too slow for a bounce
  const bool stays = v < slow && std::abs(published - came_in) < std::abs(published - expected);
  note(report_.law_error, v > 0.0 ? (published - (stays ? came_in : expected)) / came_in : published);
  ++report_.by_law;
}

void EnergyAudit::judge(const ModelTime& until) {
  for (; events_.size() > 2 && events_[1].time + 3.0 * grid_.period < until; events_.pop_front()) {
    if (events_[1].impact && events_[1].impact->kind == afm_emulator::Impact::IMPACT && flies_off()) {
      judge_impact(events_[0], events_[1], events_[2]);
    }
    judge_estimates(events_[0], events_[1]);
  }
  if (events_.empty()) return;
  const std::uint64_t wanted = std::max<std::uint64_t>(last_sample_before(events_.front().time), first_sample_);
  const std::uint64_t dropped = std::min<std::uint64_t>(wanted - first_sample_, samples_.size());
  samples_.erase(samples_.begin(), samples_.begin() + static_cast<std::ptrdiff_t>(dropped));
  first_sample_ += dropped;
}

// Whether the tip leaves the surface with the second event: a burst begins with a bounce too, and is reported when it ends.
bool EnergyAudit::flies_off() const {
  const auto next =
      std::find_if(events_.begin() + 2, events_.end(), [](const Event& e) { return e.impact.has_value(); });
  return next != events_.end() && next->impact->kind != afm_emulator::Impact::BURST &&
         next->impact->kind != afm_emulator::Impact::CONTACT_BEGUN;
}

// At that time or before it; of a time that cannot be, such as a command's that was altered, one that is not there.
std::uint64_t EnergyAudit::last_sample_before(const ModelTime& time) const {
  const double periods = (time - grid_.origin) / grid_.period;
  if (!(periods < kMostSamples)) return static_cast<std::uint64_t>(kMostSamples);
  auto sample = grid_.first + static_cast<std::uint64_t>(std::fmax(0.0, periods));
  while (sample > grid_.first && time < grid_.time(sample)) --sample;
  while (grid_.time(sample + 1) <= time) ++sample;
  return sample;
}

EnergyAudit::Motion EnergyAudit::motion(std::uint64_t first, const ModelTime& at) const {
  const Sample& a = samples_[first - first_sample_];
  const Sample& b = samples_[first + 1 - first_sample_];
  const double s = at - grid_.time(first);
  const SpringPair x(omega_[0], a.X, b.X, grid_.period), y(omega_[1], a.Y, b.Y, grid_.period);
  return {x.position(s), y.position(s), x.velocity(s), y.velocity(s)};
}

double EnergyAudit::energy(const Motion& m) const {
  return 0.5 * (square(m.U) + square(m.W) + square(omega_[0] * m.X) + square(omega_[1] * m.Y));
}

void EnergyAudit::judge_impact(const Event& before, const Event& event, const Event& after) {
  const std::uint64_t last = last_sample_before(event.time);
  if (conditioning_ > kTooNearlyBlind || last < first_sample_ + 1 || last + 2 >= first_sample_ + samples_.size())
    return;
  if (grid_.time(last - 1) < before.time || after.time < grid_.time(last + 2)) return;
  const Motion in = motion(last - 1, event.time), out = motion(last + 1, event.time);
  const afm_emulator::Impact& published = *event.impact;
  const double loss = published.energy_loss / units_.energy(), scale = energy(in) + 0.5 * square(event.eta);
  // a tip that has come to rest still has its place rounded as a height of the surface is
  const double length = std::sqrt(2.0 * scale) / omega_[1] + model_.H + std::abs(model_.y0);
  const double speed = omega_[1] * length, energy_scale = 0.5 * std::sqrt(2.0 * scale) * speed;
  // the holder moves on through the springs: what is conserved in flight is the energy in its frame
  const double angle = kTwoPi * published.surface_phase, slope = -kTwoPi * model_.H * std::sin(angle);
  // of the hammer it takes what the surface gives along x
  const double free = is_free_along_x(model_), given = free * (out.U - in.U) - (1.0 - free) * slope * (out.W - in.W);
  note(report_.balance_error, (energy(out) - energy(in) + event.eta * given + loss) / energy_scale);
  note(report_.position_error, (out.X - in.X) / length);
  note(report_.position_error, (out.Y - in.Y) / length);
  note(report_.position_error, (model_.y0 + in.Y - model_.H * std::cos(angle)) / length);
  const double u = in.U + event.eta, inverse_norm = 1.0 / std::sqrt(1.0 + free * square(slope));
  note(report_.speed_error,
       (std::abs(in.W - slope * u) * inverse_norm - published.normal_speed / units_.velocity()) / speed);
  note(report_.speed_error,
       ((u + free * slope * in.W) * inverse_norm - published.tangential_velocity / units_.velocity()) / speed);
  note(report_.allowed, kRoundings * square(conditioning_));
  report_.judged_energy += published.energy_loss;
  ++report_.judged;
}

}  // namespace afm::audit
