// The command-line options of tools for one tip or for a point of its motion: which lever over which surface; and
// which restitution, at which drag velocity.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "afm/sweep.h"
#include "common/command_line.h"
#include "common/lever_options.h"
#include "common/si_options.h"

namespace afm {

struct TipOptions {
  std::string model = "oscillator";
  double frequency_ratio = Model{}.frequency_ratio, amplitude = Model{}.H, rest_height = Model{}.y0;
  SiOptions si;
  LeverOptions lever;  // of --si
};

struct PointOptions : TipOptions {
  double eta = 3.4, gamma = 0.7, cutoff = 0.05;
  double drag_velocity = 0.0;  // [m/s] of --si, in place of eta
};

void add_model_option(CommandLine& app, std::string& model);
// --model, --frequency-ratio, --amplitude and --rest-height; of a point --eta, --gamma and --cutoff too.
void add_tip_options(CommandLine& app, TipOptions& options);
void add_options(CommandLine& app, PointOptions& options);
// --si with its scale, --lever, --surface and --load; of a point --drag-velocity too.
void add_tip_si_options(CommandLine& app, TipOptions& options);
void add_si_options(CommandLine& app, PointOptions& options);
// What these say, in natural units. Throws std::invalid_argument. Returns what is known of the lever, if one is given.
std::optional<LeverScene> take_tip_si(const CommandLine& app, TipOptions& options);
void take_si(const CommandLine& app, PointOptions& options);

// Throws std::invalid_argument where there is no such model.
ModelKind checked_kind(const std::string& name);

// By the names of the options. Throws std::invalid_argument where there is no such model.
std::vector<ParameterError> find_faults(const PointOptions& options);
// Both throw std::invalid_argument with every fault. The first shows values that were given in SI in SI.
SweepPoint checked_point(const CommandLine& app, const PointOptions& options);
Model checked_model(const PointOptions& options);

}  // namespace afm
