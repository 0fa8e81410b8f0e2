// What a run is a function of, as messages and back: its configuration and its snapshots.
#include "messages.h"

namespace afm::node {
namespace {

// One list of fields serves both ways: copy(a, b) for each field of the message and the parameter with its name.
template <class Message, class P, class Copy>
void for_each_parameter(Message& m, P& p, Copy copy) {
  copy(m.omega_v_rad_per_s, p.si.omega_v_rad_per_s);
  copy(m.omega_h_rad_per_s, p.si.omega_h_rad_per_s);
  copy(m.tip_mass_kg, p.si.tip_mass_kg);
  copy(m.lattice_spacing_m, p.si.lattice_spacing_m);
  copy(m.surface_amplitude_m, p.si.surface_amplitude_m);
  copy(m.rest_height_m, p.si.rest_height_m);
  copy(m.restitution_gamma, p.si.restitution_gamma);
  copy(m.cutoff_speed, p.si.cutoff_speed);
  copy(m.temperature_k, p.bath.temperature_k);
  copy(m.quality_factor, p.bath.quality_factor);
  copy(m.lateral_quality_factor, p.bath.lateral_quality_factor);
  copy(m.kicks_per_tau, p.bath.kicks_per_tau);
  copy(m.seed, p.bath.seed);
  copy(m.initial_phase, p.initial.phase);
  copy(m.initial_extension, p.initial.X);
  copy(m.initial_height, p.initial.y);
  copy(m.initial_u, p.initial.u);
  copy(m.initial_w, p.initial.w);
  copy(m.model, p.model);
  copy(m.tolerance, p.tolerance);
  copy(m.tolerance_of, p.tolerance_of);
  copy(m.drag_velocity, p.drag_velocity);
  copy(m.max_drag_velocity, p.max_drag_velocity);
  copy(m.pace, p.pace);
  copy(m.time_scale, p.time_scale);
  copy(m.batch_rate_hz, p.batch_rate_hz);
  copy(m.sample_rate_hz, p.sample_rate_hz);
  copy(m.friction_window_tau, p.friction_window_tau);
  copy(m.impact_budget, p.impact_budget);
  copy(m.contact_tolerance, p.contact_tolerance);
}

// The same for the state of a run: natural units, so that no digit changes.
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

constexpr auto kToMessage = [](auto& message, const auto& value) { message = value; };
constexpr auto kFromMessage = [](const auto& message, auto& value) { value = message; };

}  // namespace

afm_emulator::Configuration to_configuration(const Parameters& p, const std::string& version, const std::string& digest,
                                             const Label& label) {
  const RunSettings settings = run_settings(p);
  afm_emulator::Configuration message;
  message.header.stamp = label.stamp;
  message.epoch = label.epoch;
  message.version = version;
  message.arithmetic_digest = digest;
  for_each_parameter(message, p, kToMessage);
  message.samples_per_batch = settings.samples_per_batch;
  message.sample_period = 1.0 / p.sample_rate_hz;
  message.sample_period_tau = settings.sample_period;
  return message;
}

Parameters to_parameters(const afm_emulator::Configuration& configuration) {
  Parameters p;
  for_each_parameter(configuration, p, kFromMessage);
  return p;
}

afm_emulator::Snapshot to_snapshot(const Snapshot& s, const afm_emulator::Configuration& configuration,
                                   const afm_emulator::Applied& applied, const Label& label) {
  afm_emulator::Snapshot m;
  m.header.stamp = label.stamp;
  m.epoch = label.epoch;
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
  const LiveSettings live = apply_to(in_force, m.applied);
  Snapshot s;
  s.settings = run_settings(in_force);
  set_live(live, s.settings);
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

}  // namespace afm::node
