// The command-line options of the tools for orbits and attractors: which model, at which drag velocity.
#pragma once

#include <string>
#include <vector>

#include "afm/model.h"
#include "common/command_line.h"
#include "common/si_options.h"

namespace afm {

struct PointOptions {
  double eta = 3.4, gamma = 0.7, cutoff = 0.05;
  std::string model = "oscillator";
  double frequency_ratio = Model{}.frequency_ratio;
  SiOptions si;
  std::string drag_velocity;  // of --si, in place of eta
};

void add_options(CommandLine& app, PointOptions& options);
// --si and --drag-velocity, beside the options of add_options(); and what follows from them: eta and cutoff in natural
// units. Throws std::invalid_argument.
void add_si_options(CommandLine& app, PointOptions& options);
void take_si(const CommandLine& app, PointOptions& options);
void add_model_option(CommandLine& app, std::string& model);

// Throws std::invalid_argument where there is no such model.
ModelKind checked_kind(const std::string& name);

// Throws std::invalid_argument with every fault, by the names of the options.
Model checked_model(const PointOptions& options);
// The same, with values that were given in SI shown in SI.
Model checked_model(const CommandLine& app, const PointOptions& options);

// The numbers of an option: a range as parse_range() knows it, or several with commas between. Both throw
// std::invalid_argument with name and text of the option, and the reason.
std::vector<double> range_option(const std::string& name, const std::string& text);
std::vector<double> ranges_option(const std::string& name, const std::string& text);
// The same of an option with VALUES.
std::vector<double> ranges_option(const std::string& name, const std::vector<std::string>& texts);

// Every combination of four such options, drag velocities changing fastest; of the oscillator.
std::vector<PointOptions> grid_option(const std::string& eta, const std::string& gamma, const std::string& cutoff,
                                      const std::string& frequency_ratio);

}  // namespace afm
