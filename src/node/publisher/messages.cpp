#include "messages.h"

#include <cmath>
#include <limits>
#include <stdexcept>

#include "node/params/table.h"

namespace afm::node {
namespace {

template <class Message>
Message labelled(const Label& label) {
  Message message;
  message.header.stamp = label.stamp;
  message.epoch = label.epoch;
  return message;
}

void scale(const std::vector<double>& values, double unit, std::vector<double>& out) {
  out.resize(values.size());
  for (std::size_t i = 0; i < values.size(); ++i) out[i] = values[i] * unit;
}

afm_emulator::Impact impact_message(const Impact& impact, const Units& units) {
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

// One list of fields serves both ways. In natural units, so that no digit changes.
template <class Message, class State, class Copy>
void for_each_number(Message& m, State& s, Copy copy) {
  copy(m.next_sample, s.next_sample);
  copy(m.next_impact, s.next_impact);
  copy(m.sample_first, s.samples.first);
  copy(m.kicks, s.kick_count);
  copy(m.kick_first, s.kicks.first);
  copy(m.holder_from, s.holder.from);
  copy(m.surface_phase, s.tip.state.phase);
  copy(m.extension, s.tip.state.X);
  copy(m.u, s.tip.state.u);
  copy(m.gap, s.tip.state.g);
  copy(m.gap_rate, s.tip.state.g1);
  copy(m.sequence_normal_speed, s.tip.sequence_normal_speed);
  copy(m.sequence_gain, s.tip.sequence_gain);
  copy(m.chatter_speed, s.tip.chatter_speed);
  copy(m.chatter_count, s.tip.chatter_count);
}

template <class Message, class Sums, class Copy>
void for_each_sum(Message& m, Sums& s, Copy copy) {
  copy(m.estimate_impacts, s.impact_count);
  copy(m.estimate_energy[0], s.energy.value);
  copy(m.estimate_energy[1], s.energy.rest);
  copy(m.estimate_impulse[0], s.impulse.value);
  copy(m.estimate_impulse[1], s.impulse.rest);
  copy(m.estimate_heat[0], s.heat.value);
  copy(m.estimate_heat[1], s.heat.rest);
  copy(m.estimate_vertical[0], s.vertical.value);
  copy(m.estimate_vertical[1], s.vertical.rest);
  copy(m.estimate_samples, s.samples);
  copy(m.energy_bin_width, s.energy_bins.width);
  copy(m.impulse_bin_width, s.impulse_bins.width);
  copy(m.window_bin, s.window.current);
  for (std::size_t i = 0; i < s.energy_bins.amount.size(); ++i) copy(m.energy_bins[i], s.energy_bins.amount[i]);
  for (std::size_t i = 0; i < s.impulse_bins.amount.size(); ++i) copy(m.impulse_bins[i], s.impulse_bins.amount[i]);
  for (std::size_t i = 0; i < s.window.energy.size(); ++i) copy(m.window_bins[i], s.window.energy[i]);
}

}  // namespace

afm_emulator::ModelTime to_message(const ModelTime& time) {
  afm_emulator::ModelTime message;
  message.tau = time.tau;
  message.phase = time.phase;
  return message;
}

ModelTime from_message(const afm_emulator::ModelTime& time) { return {time.tau, time.phase}; }

afm_emulator::Deflection to_deflection(const Batch& batch, const Live& live, const Units& units, const Label& label) {
  auto message = labelled<afm_emulator::Deflection>(label);
  message.time = to_message(batch.first_sample_time);
  message.first_sample = batch.first_sample;
  message.sample_period = 1.0 / live.sample_rate_hz;
  message.holder_position = batch.holder * units.length();
  message.lateral_impulse = batch.impulse * units.force() * units.time();
  message.drag_velocity = live.drag_velocity;
  scale(batch.vertical, units.length(), message.vertical);
  scale(batch.lateral, units.length(), message.lateral);
  return message;
}

afm_emulator::ImpactArray to_impacts(const Batch& batch, const Units& units, const Label& label) {
  auto message = labelled<afm_emulator::ImpactArray>(label);
  message.first_index = batch.first_impact;
  message.impacts.reserve(batch.impacts.size());
  for (const Impact& impact : batch.impacts) message.impacts.push_back(impact_message(impact, units));
  return message;
}

afm_emulator::Friction to_friction(const Batch& batch, const Live& live, const Units& units, const Label& label) {
  const FrictionEstimate& estimate = batch.friction;
  auto message = labelled<afm_emulator::Friction>(label);
  message.begin = to_message(batch.begin);
  message.time = to_message(batch.end);
  message.first_impact = batch.first_impact;
  message.impact_limit = batch.impact_limit;
  message.drag_velocity = live.drag_velocity;
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
  message.window_k_f_natural = estimate.window_K_f;
  message.mean_lateral_force = estimate.mean_lateral_force * units.force();
  message.mean_lateral_force_std_error = estimate.mean_lateral_force_std_error * units.force();
  message.k_f_work = estimate.K_f_work * units.friction();
  message.k_f_work_std_error = estimate.K_f_work_std_error * units.friction();
  message.k_f_work_natural = estimate.K_f_work;
  message.mean_normal_force = estimate.mean_normal_force * units.force();
  message.heat_to_bath = estimate.heat_to_bath * units.energy();
  return message;
}

afm_emulator::Applied to_applied(const Report& report, const Parameters& parameters, const Label& label) {
  const InForce& in_force = report.in_force;
  const RunSettings settings = run_settings(parameters);
  auto message = labelled<afm_emulator::Applied>(label);
  message.number = in_force.number;
  message.cause = in_force.cause;
  message.time = to_message(report.state.time);
  message.first_impact = report.state.impacts;
  message.first_sample = report.state.samples;
  message.drag_velocity = in_force.live.drag_velocity;
  for_each_live(message, in_force.live, kToMessage);
  message.samples_per_batch = settings.samples_per_batch;
  message.sample_period_tau = settings.sample_period;
  message.model = name(in_force.level.kind);
  message.contact_tolerance = in_force.level.contact_tolerance;
  message.expected_error = in_force.expected_error;
  message.energy_dropped = in_force.energy_dropped * Units(parameters.si).energy();
  return message;
}

RunSettings apply_to(Parameters& in_force, const afm_emulator::Applied& applied) {
  in_force.drag_velocity = applied.drag_velocity;
  for_each_live(applied, in_force, kFromMessage);
  RunSettings settings = run_settings(in_force);
  settings.contact_tolerance = applied.contact_tolerance;
  if (!parse(applied.model, settings.model.kind)) throw std::invalid_argument("unknown model: " + applied.model);
  return settings;
}

afm_emulator::Configuration to_configuration(const Parameters& p, const std::string& version, const std::string& digest,
                                             const Label& label) {
  const RunSettings settings = run_settings(p);
  auto message = labelled<afm_emulator::Configuration>(label);
  message.version = version;
  message.arithmetic_digest = digest;
  for_each_of_run(message, p, kToMessage);
  message.samples_per_batch = settings.samples_per_batch;
  message.sample_period = 1.0 / p.sample_rate_hz;
  message.sample_period_tau = settings.sample_period;
  return message;
}

Parameters to_parameters(const afm_emulator::Configuration& configuration) {
  Parameters p;
  for_each_of_run(configuration, p, kFromMessage);
  return p;
}

afm_emulator::Snapshot to_snapshot(const Snapshot& s, const afm_emulator::Configuration& configuration,
                                   const afm_emulator::Applied& applied, const Label& label) {
  auto m = labelled<afm_emulator::Snapshot>(label);
  m.time = to_message(s.tip.time);
  m.configuration = configuration;
  m.applied = applied;
  m.configuration.header = m.applied.header = std_msgs::Header();
  m.sample_origin = to_message(s.samples.origin);
  m.kick_origin = to_message(s.kicks.origin);
  m.holder_since = to_message(s.holder.since);
  m.phase = static_cast<std::uint8_t>(s.tip.phase);
  for_each_number(m, s, kToMessage);
  const FrictionSums& sums = s.friction.sums();
  m.estimate_start = to_message(sums.start);
  m.window_start = to_message(sums.window_start);
  for_each_sum(m, sums, kToMessage);
  return m;
}

Snapshot from_message(const afm_emulator::Snapshot& m) {
  Parameters in_force = to_parameters(m.configuration);
  Snapshot s;
  s.settings = apply_to(in_force, m.applied);
  s.tip.time = from_message(m.time);
  s.tip.phase = static_cast<TipSnapshot::Phase>(m.phase);
  s.samples.period = s.settings.sample_period;
  s.samples.origin = from_message(m.sample_origin);
  s.kicks.period = 1.0 / s.settings.bath.kicks_per_tau;
  s.kicks.origin = from_message(m.kick_origin);
  s.holder.since = from_message(m.holder_since);
  for_each_number(m, s, kFromMessage);
  FrictionSums sums(s.settings.friction_window);
  sums.eta = s.settings.eta;
  sums.start = from_message(m.estimate_start);
  sums.window_start = from_message(m.window_start);
  for_each_sum(m, sums, kFromMessage);
  s.friction = Friction(sums);
  return s;
}

afm_emulator::Control::Response to_control(const Answer& answer, const SiModel& si) {
  const Units units(si);
  const Measured& m = answer.measured;
  const double n = static_cast<double>(m.samples), seconds = (answer.time - m.begin) * units.time();
  const double k_v = spring_constant(si);
  const double k_h = si.tip_mass_kg * si.omega_h_rad_per_s * si.omega_h_rad_per_s;
  const double v0 = m.drag_velocity != 0.0 ? m.drag_velocity : std::numeric_limits<double>::quiet_NaN();
  afm_emulator::Control::Response r;
  r.epoch = answer.epoch;
  r.begin = to_message(m.begin);
  r.end = to_message(answer.time);
  r.applied = answer.number;
  r.samples = m.samples;
  r.mean_vertical = m.vertical / n * units.length();
  r.rms_vertical = std::sqrt(m.vertical_squares / n) * units.length();
  r.mean_lateral_force = m.impulse / (answer.time - m.begin) * units.force();
  r.rms_lateral_force = k_h * (std::sqrt(m.lateral_squares / n) * units.length());
  r.mean_normal_force = k_v * r.mean_vertical;
  r.impact_count = m.bounces;
  r.energy_loss = m.energy_loss * units.energy();
  r.k_f = r.energy_loss / (v0 * v0 * seconds);
  r.k_f_work = r.mean_lateral_force / v0;
  return r;
}

}  // namespace afm::node
