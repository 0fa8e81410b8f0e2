#include "message_conversion.h"

namespace afm::node {
namespace {

template <class Message>
Message labelled(const Label& label) {
  Message message;
  message.header.stamp = label.stamp;
  message.epoch = label.epoch;
  return message;
}

template <class Message>
void write_level(const AppliedLevel& applied, const Units& units, Message& message) {
  message.model = name(applied.level.kind);
  message.contact_tolerance = applied.level.contact_tolerance;
  message.expected_error = applied.expected_error;
  message.energy_dropped = applied.energy_dropped * units.energy();
}

void scale(const std::vector<double>& values, double unit, std::vector<double>& out) {
  out.resize(values.size());
  for (std::size_t i = 0; i < values.size(); ++i) out[i] = values[i] * unit;
}

}  // namespace

ros::Time to_stamp(std::int64_t wall_ns) {
  ros::Time stamp;
  return stamp.fromNSec(static_cast<std::uint64_t>(wall_ns));
}

afm_emulator::ModelTime to_message(const ModelTime& time) {
  afm_emulator::ModelTime message;
  message.tau = time.tau;
  message.phase = time.phase;
  return message;
}

ModelTime from_message(const afm_emulator::ModelTime& time) { return {time.tau, time.phase}; }

afm_emulator::Deflection to_deflection(const Batch& batch, double sample_period_s, const Units& units,
                                       const Label& label) {
  auto message = labelled<afm_emulator::Deflection>(label);
  message.time = to_message(batch.first_sample_time);
  message.first_sample = batch.first_sample;
  message.sample_period = sample_period_s;
  scale(batch.vertical, units.length(), message.vertical);
  scale(batch.lateral, units.length(), message.lateral);
  return message;
}

afm_emulator::Impact to_message(const Impact& impact, const Units& units) {
  afm_emulator::Impact message;
  message.time = to_message(impact.time);
  message.surface_phase = impact.surface_phase;
  message.normal_speed = impact.normal_speed * units.velocity();
  message.tangential_velocity = impact.tangential_velocity * units.velocity();
  message.energy_loss = impact.energy_loss * units.energy();
  message.kind = static_cast<std::uint8_t>(impact.kind);
  message.count = impact.count;
  return message;
}

afm_emulator::ImpactArray to_impacts(const Batch& batch, const Units& units, const Label& label) {
  auto message = labelled<afm_emulator::ImpactArray>(label);
  message.first_index = batch.first_impact;
  message.impacts.reserve(batch.impacts.size());
  for (const Impact& impact : batch.impacts) message.impacts.push_back(to_message(impact, units));
  return message;
}

afm_emulator::Friction to_friction(const Batch& batch, double drag_velocity, const Units& units, const Label& label) {
  const FrictionEstimate& estimate = batch.friction;
  auto message = labelled<afm_emulator::Friction>(label);
  message.time = to_message(batch.end);
  message.drag_velocity = drag_velocity;
  message.eta = batch.eta;
  message.force = estimate.force * units.force();
  message.force_std_error = estimate.force_std_error * units.force();
  message.k_f = estimate.K_f * units.friction();
  message.k_f_std_error = estimate.K_f_std_error * units.friction();
  message.k_f_natural = estimate.K_f;
  message.energy_loss = estimate.energy_loss * units.energy();
  message.impact_count = estimate.impact_count;
  message.window_force = estimate.window_force * units.force();
  message.window_k_f = estimate.window_K_f * units.friction();
  message.window_k_f_std_error = estimate.window_K_f_std_error * units.friction();
  message.mean_lateral_force = estimate.mean_lateral_force * units.force();
  message.mean_lateral_force_std_error = estimate.mean_lateral_force_std_error * units.force();
  message.k_f_work = estimate.K_f_work * units.friction();
  message.k_f_work_std_error = estimate.K_f_work_std_error * units.friction();
  message.heat_to_bath = estimate.heat_to_bath * units.energy();
  return message;
}

afm_emulator::AppliedDrag to_applied_drag(const StepperState& state, double drag_velocity, const AppliedLevel& level,
                                          const Units& units, const Label& label) {
  auto message = labelled<afm_emulator::AppliedDrag>(label);
  message.time = to_message(state.time);
  message.drag_velocity = drag_velocity;
  message.first_impact = state.impacts;
  write_level(level, units, message);
  return message;
}

afm_emulator::AppliedParameters to_applied_parameters(const StepperState& state, const Parameters& p,
                                                      const AppliedLevel& level, const Label& label) {
  const EmulatorSettings settings = emulator_settings(p);
  auto message = labelled<afm_emulator::AppliedParameters>(label);
  message.time = to_message(state.time);
  message.first_impact = state.impacts;
  message.first_sample = state.samples;
  message.first_command = state.commands;
  write_live(live_parameters(p), message);
  message.samples_per_batch = settings.samples_per_batch;
  message.sample_period_tau = settings.sample_period;
  write_level(level, Units(p.si), message);
  return message;
}

afm_emulator::EmulatorStatus to_status(const StepperState& state, const Units& units, const Label& label) {
  auto message = labelled<afm_emulator::EmulatorStatus>(label);
  message.time = to_message(state.time);
  message.real_time_factor = state.real_time_factor;
  message.lag = state.lag;
  message.worst_lag = state.worst_lag;
  message.late_batches = state.late_batches;
  message.budget_exhausted = state.counters.budget_exhausted;
  message.search_failures = state.counters.search_failures;
  message.worst_penetration = state.counters.worst_penetration * units.length();
  message.paused = state.paused;
  return message;
}

}  // namespace afm::node
