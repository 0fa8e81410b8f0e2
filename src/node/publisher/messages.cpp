#include "messages.h"

#include <cmath>
#include <limits>
#include <stdexcept>

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

const char* to_text(Cause cause) {
  switch (cause) {
    case Cause::epoch: return "epoch";
    case Cause::drag_velocity: return "drag_velocity";
    case Cause::rest_height: return "rest_height";
    case Cause::load: return "load";
    case Cause::parameters: return "parameters";
    case Cause::scene: return "scene";
    case Cause::timeout: break;
  }
  return "timeout";
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

afm_emulator::Applied to_applied(const Report& report, const Parameters& in_force, const Label& label) {
  const RunSettings settings = run_settings(in_force);
  auto message = labelled<afm_emulator::Applied>(label);
  message.number = report.number;
  message.cause = to_text(report.cause);
  message.time = to_message(report.state.time);
  message.first_impact = report.state.impacts;
  message.first_sample = report.state.samples;
  message.drag_velocity = report.live.drag_velocity;
  for (const LiveField& field : kLiveFields) message.*field.applied = report.live.*field.value;
  message.samples_per_batch = settings.samples_per_batch;
  message.sample_period_tau = settings.sample_period;
  message.model = name(report.level.level.kind);
  message.contact_tolerance = report.level.level.contact_tolerance;
  message.expected_error = report.level.expected_error;
  message.energy_dropped = report.level.energy_dropped * Units(in_force.si).energy();
  return message;
}

Live live_of(const afm_emulator::Applied& applied) {
  Live live;
  live.drag_velocity = applied.drag_velocity;
  for (const LiveField& field : kLiveFields) live.*field.value = applied.*field.applied;
  return live;
}

Level level_of(const afm_emulator::Applied& applied) {
  Level level{ModelKind::oscillator, applied.contact_tolerance};
  if (!parse(applied.model, level.kind)) throw std::invalid_argument("unknown model: " + applied.model);
  return level;
}

LiveSettings apply_to(Parameters& in_force, const afm_emulator::Applied& applied) {
  set_live(live_of(applied), in_force);
  LiveSettings live = live_settings(run_settings(in_force));
  live.level = level_of(applied);
  return live;
}

afm_emulator::Control::Response to_control(const Answer& answer, const SiModel& si) {
  const Units units(si);
  const Measured& m = answer.measured;
  const double n = static_cast<double>(m.samples), seconds = (answer.time - m.begin) * units.time();
  const double k_v = spring_constant(si);
  const double k_h = si.tip_mass_kg * si.omega_h_rad_per_s * si.omega_h_rad_per_s;
  const double v0 = answer.drag_velocity != 0.0 ? answer.drag_velocity : std::numeric_limits<double>::quiet_NaN();
  afm_emulator::Control::Response r;
  r.epoch = answer.epoch;
  r.begin = to_message(m.begin);
  r.end = to_message(answer.time);
  r.applied = answer.number;
  r.samples = m.samples;
  r.mean_vertical = m.vertical / n * units.length();
  r.rms_vertical = std::sqrt(m.vertical_squares / n) * units.length();
  r.mean_lateral_force = -k_h * (m.lateral / n * units.length());
  r.rms_lateral_force = k_h * (std::sqrt(m.lateral_squares / n) * units.length());
  r.mean_normal_force = k_v * r.mean_vertical;
  r.impact_count = m.bounces;
  r.energy_loss = m.energy_loss * units.energy();
  r.k_f = r.energy_loss / (v0 * v0 * seconds);
  r.k_f_work = r.mean_lateral_force / v0;
  return r;
}

afm_emulator::EmulatorStatus to_status(const RunnerState& state, const Units& units, const Label& label) {
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
