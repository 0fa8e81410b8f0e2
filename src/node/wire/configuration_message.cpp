// The configuration of a run as a message, and back: what it takes to simulate it again.
#include <stdexcept>

#include "message_conversion.h"

namespace afm::node {
namespace {

void write_model(const SiModel& si, afm_emulator::Configuration& message) {
  message.omega_v_rad_per_s = si.omega_v_rad_per_s;
  message.omega_h_rad_per_s = si.omega_h_rad_per_s;
  message.tip_mass_kg = si.tip_mass_kg;
  message.lattice_spacing_m = si.lattice_spacing_m;
  message.surface_amplitude_m = si.surface_amplitude_m;
  message.rest_height_m = si.rest_height_m;
  message.restitution_gamma = si.restitution_gamma;
  message.cutoff_speed = si.cutoff_speed;
}

void write_bath(const SiBath& bath, afm_emulator::Configuration& message) {
  message.temperature_k = bath.temperature_k;
  message.quality_factor = bath.quality_factor;
  message.lateral_quality_factor = bath.lateral_quality_factor;
  message.kicks_per_tau = bath.kicks_per_tau;
  message.seed = bath.seed;
}

SiBath si_bath(const afm_emulator::Configuration& message) {
  return {message.temperature_k, message.quality_factor, message.lateral_quality_factor, message.kicks_per_tau,
          message.seed};
}

void write_initial_state(const FreeState& initial, afm_emulator::Configuration& message) {
  message.initial_phase = initial.phase;
  message.initial_extension = initial.X;
  message.initial_height = initial.y;
  message.initial_u = initial.u;
  message.initial_w = initial.w;
}

}  // namespace

afm_emulator::Configuration to_configuration(const Parameters& p, const std::string& version, const std::string& digest,
                                             const Label& label) {
  const EmulatorSettings settings = emulator_settings(p);
  afm_emulator::Configuration message;
  message.header.stamp = label.stamp;
  message.epoch = label.epoch;
  message.version = version;
  message.arithmetic_digest = digest;
  message.model = p.model;
  message.tolerance = p.tolerance;
  message.tolerance_of = p.tolerance_of;
  message.level_table = p.level_table_digest;
  write_model(p.si, message);
  write_bath(p.bath, message);
  write_initial_state(p.initial, message);
  message.drag_velocity = p.drag_velocity;
  message.max_drag_velocity = p.max_drag_velocity;
  message.time_scale = p.time_scale;
  message.batch_rate_hz = p.batch_rate_hz;
  message.sample_rate_hz = p.sample_rate_hz;
  message.samples_per_batch = settings.samples_per_batch;
  message.sample_period = 1.0 / p.sample_rate_hz;
  message.sample_period_tau = settings.sample_period;
  message.friction_window_tau = p.friction_window_tau;
  message.impact_budget = p.impact_budget;
  message.contact_tolerance = p.contact_tolerance;
  return message;
}

SiModel si_model(const afm_emulator::Configuration& message) {
  SiModel si;
  si.omega_v_rad_per_s = message.omega_v_rad_per_s;
  si.omega_h_rad_per_s = message.omega_h_rad_per_s;
  si.tip_mass_kg = message.tip_mass_kg;
  si.lattice_spacing_m = message.lattice_spacing_m;
  si.surface_amplitude_m = message.surface_amplitude_m;
  si.rest_height_m = message.rest_height_m;
  si.restitution_gamma = message.restitution_gamma;
  si.cutoff_speed = message.cutoff_speed;
  return si;
}

Parameters to_parameters(const afm_emulator::Configuration& c) {
  Parameters p;
  p.si = si_model(c);
  p.bath = si_bath(c);
  p.model = c.model;
  p.tolerance = c.tolerance;
  p.tolerance_of = c.tolerance_of;
  p.level_table_digest = c.level_table;
  p.drag_velocity = c.drag_velocity;
  p.max_drag_velocity = c.max_drag_velocity;
  p.initial = {c.initial_phase, c.initial_extension, c.initial_height, c.initial_u, c.initial_w};
  p.time_scale = c.time_scale;
  p.batch_rate_hz = c.batch_rate_hz;
  p.sample_rate_hz = c.sample_rate_hz;
  p.friction_window_tau = c.friction_window_tau;
  p.impact_budget = c.impact_budget;
  p.contact_tolerance = c.contact_tolerance;
  return p;
}

EmulatorSettings emulator_settings(const afm_emulator::Configuration& message) {
  const SiModel si = si_model(message);
  EmulatorSettings settings;
  settings.model = Units(si).to_natural(si);
  // auto begins as the full model; the first drag velocity brings its level
  if (message.model != kAuto && !parse(message.model, settings.model.kind)) {
    throw std::invalid_argument("unknown model: " + message.model);
  }
  settings.bath = Units(si).to_natural(si_bath(message));
  settings.eta = to_eta(message.drag_velocity, si);
  settings.initial = {message.initial_phase, message.initial_extension, message.initial_height, message.initial_u,
                      message.initial_w};
  settings.sample_period = message.sample_period_tau;
  settings.samples_per_batch = message.samples_per_batch;
  settings.friction_window = message.friction_window_tau;
  settings.impact_budget = message.impact_budget;
  settings.contact_tolerance = message.contact_tolerance;
  return settings;
}

}  // namespace afm::node
