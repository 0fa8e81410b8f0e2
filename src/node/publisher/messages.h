// Between the core's figures in natural units and messages in SI: the only place, so that a replay gets the same bytes
// as the node. Pure functions; times, phases and indices pass as they are. Sequence numbers are the publisher's.
#pragma once

#include <afm_emulator/Applied.h>
#include <afm_emulator/Configuration.h>
#include <afm_emulator/Control.h>
#include <afm_emulator/Deflection.h>
#include <afm_emulator/Friction.h>
#include <afm_emulator/ImpactArray.h>
#include <afm_emulator/Snapshot.h>
#include <ros/time.h>

#include <cstdint>
#include <string>

#include "afm/run.h"
#include "afm/units.h"
#include "node/params/parameters.h"
#include "node/runner/report.h"

namespace afm::node {

// Every message starts with it.
struct Label {
  ros::Time stamp;
  std::uint32_t epoch = 0;
};

afm_emulator::ModelTime to_message(const ModelTime& time);
ModelTime from_message(const afm_emulator::ModelTime& time);

// A batch, with the parameters in force in it.
afm_emulator::Deflection to_deflection(const Batch& batch, const Live& live, const Units& units, const Label& label);
afm_emulator::ImpactArray to_impacts(const Batch& batch, const Units& units, const Label& label);
afm_emulator::Friction to_friction(const Batch& batch, const Live& live, const Units& units, const Label& label);

// The state at which it takes effect is that of the report.
afm_emulator::Applied to_applied(const Report& report, const Parameters& parameters, const Label& label);
// version and digest are of the program that runs.
afm_emulator::Configuration to_configuration(const Parameters& parameters, const std::string& version,
                                             const std::string& digest, const Label& label);
// Parameters that are no part of a run are at their defaults.
Parameters to_parameters(const afm_emulator::Configuration& configuration);

afm_emulator::Snapshot to_snapshot(const Snapshot& snapshot, const afm_emulator::Configuration& configuration,
                                   const afm_emulator::Applied& applied, const Label& label);
Snapshot from_message(const afm_emulator::Snapshot& message);

// Applies it to the parameters in force. Returns the settings of the run from there on. Throws std::invalid_argument if
// there is no such model.
RunSettings apply_to(Parameters& in_force, const afm_emulator::Applied& applied);

// The answer to a control period: its means.
afm_emulator::Control::Response to_control(const Answer& answer, const SiModel& si);

}  // namespace afm::node
