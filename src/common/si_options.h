// --si of a tool: physical options are taken in SI and physical columns printed in SI. Inside, all is in natural units.
#pragma once

#include <string>
#include <vector>

#include "command_line.h"
#include "table_units.h"

namespace afm {

struct SiOptions {
  bool on = false;
  SiModel scale;  // only its lattice spacing, omega_v and tip mass count
};

constexpr const char* kScaleOptions[] = {"lattice-spacing", "omega-v", "tip-mass"};

// --si and the scale: --lattice-spacing, --omega-v, --tip-mass. The help says what --si does.
void add_si_options(CommandLine& app, SiOptions& options);

// Of --drag-velocity, which a tool with --si takes in place of --eta.
constexpr const char* kDragVelocityHelp = "in m/s, in place of --eta; with --si";
// True if it is given. Throws std::invalid_argument where it stands without --si, or beside --eta.
bool has_drag_velocity(const CommandLine& app, const SiOptions& options);

// Throws std::invalid_argument where the scale is out of range, or given without --si.
Units checked_units(const CommandLine& app, const SiOptions& options);

// The same faults as the user knows them: with --si the value of an option that was given is shown in SI.
std::vector<ParameterError> as_given(const CommandLine& app, const SiOptions& options,
                                     const std::vector<ParameterError>& faults);

// How the tool's tables of natural numbers are written.
TableUnits table_units(const SiOptions& options);

// With --si an option that was given is in SI: its values become natural. A default is natural already.
// Which options have a unit stands in one table.
void take_si(const CommandLine& app, const SiOptions& options, const std::string& name, std::vector<double>& values);
void take_si(const CommandLine& app, const SiOptions& options, const std::string& name, double& value);

}  // namespace afm
