// --lever, --surface and --load of a tool: the files of config/levers and config/surfaces, which the emulator takes
// too, or files of one's own.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "afm/units.h"
#include "command_line.h"
#include "si_options.h"

namespace afm {

struct LeverOptions {
  std::string lever, surface;  // names, or paths that end in .yaml
  double load_n = 0.0;         // [N]

  static bool are_given(const CommandLine& app) {
    return app.is_given("lever") || app.is_given("surface") || app.is_given("load");
  }
};

// The scenes, levers and surfaces that are known by name: of an installed tool those beside it, else the sources'.
std::filesystem::path config_folder();

// What is wrong with the file of a lever or of a surface, or nothing.
std::string find_lever_file_fault(const std::string& path);
std::string find_surface_file_fault(const std::string& path);

void add_lever_options(CommandLine& app, LeverOptions& options);

// The paper's lever on mica without a load, but for what is given.
struct LeverScene {
  SiModel si;
  SiBath bath;  // at temperature 0: quality factors and kicks, as far as the lever's file has them

  // Throws std::invalid_argument with what is wrong in a file, or given beside it.
  LeverScene(const CommandLine& app, const LeverOptions& options);

  // The value in natural units of an option of the tool that is not given: amplitude, cutoff, frequency-ratio,
  // rest-height, quality-factor, lateral-quality-factor, kicks-per-tau.
  void take(const CommandLine& app, const std::string& option, double& value) const;
  void take(const CommandLine& app, const std::string& option, std::vector<double>& value) const;
};

// Of a tool with --si: nothing if no lever, surface or load is given. Else they set its scale too.
std::optional<LeverScene> take_lever(const CommandLine& app, const LeverOptions& options, SiOptions& si);

}  // namespace afm
