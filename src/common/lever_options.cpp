#include "lever_options.h"

#include <yaml-cpp/yaml.h>

#include <filesystem>
#include <map>
#include <stdexcept>

namespace afm {
namespace {

namespace fs = std::filesystem;

using Values = std::map<std::string, double*>;  // by the key of a file

constexpr const char* kTwice[][2] = {{"lever", "omega-v"},         {"lever", "tip-mass"},
                                     {"lever", "frequency-ratio"}, {"surface", "lattice-spacing"},
                                     {"surface", "amplitude"},     {"load", "rest-height"}};

// Of an installed tool beside it, else in the sources.
fs::path config() {
  const fs::path installed =
      fs::read_symlink("/proc/self/exe").parent_path().parent_path().parent_path() / "share/afm_emulator/config";
  return fs::exists(installed) ? installed : fs::path(AFM_CONFIG);
}

std::string names_in(const fs::path& folder) {
  std::string names;
  for (const auto& entry : fs::directory_iterator(folder)) names += " " + entry.path().stem().string();
  return names;
}

void read(const std::string& option, const std::string& name, const Values& values) {
  if (name.empty()) return;
  const auto refuse = [&](const std::string& what) {
    throw std::invalid_argument(option + " = " + name + ": " + what);
  };
  const fs::path folder = config() / (option + "s");
  const fs::path path = fs::path(name).extension() == ".yaml" ? fs::path(name) : folder / (name + ".yaml");
  if (!fs::exists(path)) refuse("there is no such file, nor one of" + names_in(folder));
  try {
    for (const auto& entry : YAML::LoadFile(path.string())) {
      const std::string key = entry.first.as<std::string>();
      if (values.count(key) == 0) refuse("it says nothing of a " + option + " by its " + key);
      if (!YAML::convert<double>::decode(entry.second, *values.at(key))) refuse(key + " must be a number");
    }
  } catch (const YAML::Exception& fault) {
    refuse(fault.what());
  }
}

}  // namespace

void add_lever_options(CommandLine& app, LeverOptions& o) {
  app.option("lever", o.lever, "ppp_cont or another of config/levers, or the path of a .yaml of your own");
  app.option("surface", o.surface, "nacl or another of config/surfaces, or the path of a .yaml of your own");
  app.option("load", o.load_n, "in N, in place of --rest-height");
}

LeverScene::LeverScene(const CommandLine& app, const LeverOptions& o) {
  for (const auto& [one, other] : kTwice) {
    if (!app.is_given(one) || !app.is_given(other)) continue;
    throw std::invalid_argument(std::string(other) + ": is given beside --" + one + ": give one of them");
  }
  Lever lever;
  read("lever", o.lever,
       {{"spring_constant_n_per_m", &lever.spring_constant_n_per_m},
        {"resonance_hz", &lever.resonance_hz},
        {"lateral_spring_constant_n_per_m", &lever.lateral_spring_constant_n_per_m},
        {"quality_factor", &bath.quality_factor},
        {"lateral_quality_factor", &bath.lateral_quality_factor},
        {"kicks_per_tau", &bath.kicks_per_tau}});
  read("surface", o.surface,
       {{"lattice_spacing_m", &si.lattice_spacing_m}, {"surface_amplitude_m", &si.surface_amplitude_m}});
  std::vector<ParameterError> faults;
  if (!o.lever.empty()) faults = find_faults(lever);
  if (faults.empty()) faults = set_lever_and_load(lever, o.load_n, si);
  if (faults.empty()) faults = find_faults(si);
  if (!faults.empty()) throw std::invalid_argument(describe(faults));
}

void LeverScene::take(const CommandLine& app, const std::string& option, double& value) const {
  if (app.is_given(option)) return;
  const Model model = Units(si).to_natural(si);
  const std::map<std::string, double> values{{"amplitude", model.H},
                                             {"cutoff", model.v_c},
                                             {"frequency-ratio", model.frequency_ratio},
                                             {"rest-height", model.y0},
                                             {"quality-factor", bath.quality_factor},
                                             {"lateral-quality-factor", bath.lateral_quality_factor},
                                             {"kicks-per-tau", bath.kicks_per_tau}};
  value = values.at(option);
}

void LeverScene::take(const CommandLine& app, const std::string& option, std::vector<double>& value) const {
  double one = 0.0;
  take(app, option, one);
  if (!app.is_given(option)) value = {one};
}

}  // namespace afm
