// The core's figures in natural units to messages in SI: the only place, so that a checker gets the same bits as the
// node. Pure functions; times, phases and indices pass as they are.
#pragma once

#include <afm_emulator/AppliedDrag.h>
#include <afm_emulator/AppliedParameters.h>
#include <afm_emulator/Configuration.h>
#include <afm_emulator/Deflection.h>
#include <afm_emulator/EmulatorStatus.h>
#include <afm_emulator/Friction.h>
#include <afm_emulator/ImpactArray.h>
#include <ros/time.h>

#include <cstdint>
#include <stdexcept>
#include <string>

#include "afm/emulator.h"
#include "afm/units.h"
#include "node/stepping/events.h"
#include "node/parameters/parameters.h"

namespace afm::node {

// What every message starts with. The sequence number is the publisher's.
struct Label {
  ros::Time stamp;
  std::uint32_t epoch = 0;
};

// Wall clock in nanoseconds since 1970, as a stamp: never the simulated time of /clock.
ros::Time to_stamp(std::int64_t wall_ns);

afm_emulator::ModelTime to_message(const ModelTime& time);
ModelTime from_message(const afm_emulator::ModelTime& time);

afm_emulator::Deflection to_deflection(const Batch& batch, double sample_period_s, const Units& units,
                                       const Label& label);
afm_emulator::Impact to_message(const Impact& impact, const Units& units);
afm_emulator::ImpactArray to_impacts(const Batch& batch, const Units& units, const Label& label);
afm_emulator::Friction to_friction(const Batch& batch, double drag_velocity, const Units& units, const Label& label);
// The state is that at which the command takes effect.
afm_emulator::AppliedDrag to_applied_drag(const StepperState& state, double drag_velocity, const AppliedLevel& level,
                                          const Units& units, const Label& label);

afm_emulator::AppliedParameters to_applied_parameters(const StepperState& state, const Parameters& parameters,
                                                      const AppliedLevel& level, const Label& label);

// The level that an AppliedDrag or AppliedParameters reports. Throws std::invalid_argument if there is no such model.
template <class Applied>
Level level_of(const Applied& applied) {
  Level level{ModelKind::oscillator, applied.contact_tolerance};
  if (!parse(applied.model, level.kind)) throw std::invalid_argument("unknown model: " + applied.model);
  return level;
}

// The live parameters that an AppliedParameters or a Checkpoint reports.
template <class Report>
LiveParameters to_live(const Report& report) {
  return {report.restitution_gamma, report.cutoff_speed,           report.rest_height_m,
          report.sample_rate_hz,    report.friction_window_tau,    report.temperature_k,
          report.quality_factor,    report.lateral_quality_factor, report.kicks_per_tau};
}
template <class Report>
void write_live(const LiveParameters& live, Report& report) {
  report.restitution_gamma = live.restitution_gamma;
  report.cutoff_speed = live.cutoff_speed;
  report.rest_height_m = live.rest_height_m;
  report.sample_rate_hz = live.sample_rate_hz;
  report.friction_window_tau = live.friction_window_tau;
  report.temperature_k = live.temperature_k;
  report.quality_factor = live.quality_factor;
  report.lateral_quality_factor = live.lateral_quality_factor;
  report.kicks_per_tau = live.kicks_per_tau;
}

// Those fields of the status that the stepping thread knows.
afm_emulator::EmulatorStatus to_status(const StepperState& state, const Units& units, const Label& label);

// version and digest are of the program that runs.
afm_emulator::Configuration to_configuration(const Parameters& parameters, const std::string& version,
                                             const std::string& digest, const Label& label);
// The run again: exactly what the messages were made from. Parameters that are no part of a run are at their defaults.
Parameters to_parameters(const afm_emulator::Configuration& configuration);
SiModel si_model(const afm_emulator::Configuration& configuration);
EmulatorSettings emulator_settings(const afm_emulator::Configuration& configuration);

}  // namespace afm::node
