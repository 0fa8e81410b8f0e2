#include "lever_options.h"

#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <stdexcept>
#include <vector>

namespace afm {
namespace {

namespace fs = std::filesystem;

using Keys = std::map<std::string, double*>;  // of a file, and where their numbers belong

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

class FileError : public std::invalid_argument {
 public:
  FileError(const std::string& option, const std::string& name, const std::string& what_is_wrong)
      : std::invalid_argument(option + " = " + name + ": " + what_is_wrong), reason(what_is_wrong) {}
  std::string reason;
};

// A lever or a surface in a file: numbers by their keys.
class File {
 public:
  // option: lever or surface. Throws FileError where it is no such file, or has a key that is not known.
  File(const std::string& option, const std::string& name, const std::vector<Keys>& known)
      : option_(option), name_(name) {
    const fs::path folder = config() / (option + "s");
    const fs::path path = fs::path(name).extension() == ".yaml" ? fs::path(name) : folder / (name + ".yaml");
    if (!fs::exists(path)) refuse("there is no such file, nor one of" + names_in(folder));
    if (fs::is_directory(path)) refuse("it is a folder, not a file");
    try {
      const YAML::Node root = YAML::LoadFile(path.string());
      if (!root.IsMap()) refuse("it must hold lines of a key and a number");
      for (const auto& entry : root) {
        const std::string key = entry.first.as<std::string>();
        if (std::none_of(known.begin(), known.end(), [&](const Keys& keys) { return keys.count(key) > 0; }))
          refuse("it says nothing of a " + option + " by its " + key);
        if (!YAML::convert<double>::decode(entry.second, values_[key])) refuse(key + " must be a number");
      }
    } catch (const YAML::Exception& fault) {
      refuse(fault.what());
    }
  }

  bool has_one_of(const Keys& keys) const {
    return std::any_of(keys.begin(), keys.end(), [&](const auto& key) { return values_.count(key.first) > 0; });
  }
  // Throws FileError where one of the keys is missing.
  void need(const Keys& keys) const {
    for (const auto& key : keys) {
      if (values_.count(key.first) == 0) refuse("it lacks " + key.first);
    }
  }
  // The numbers of those that are there.
  void take(const Keys& keys) const {
    for (const auto& [key, number] : keys) {
      const auto found = values_.find(key);
      if (found != values_.end()) *number = found->second;
    }
  }

  [[noreturn]] void refuse(const std::string& what) const { throw FileError(option_, name_, what); }

 private:
  std::string option_, name_;
  std::map<std::string, double> values_;
};

// By its springs, or by its frequencies as the model has them.
void read_lever(const std::string& name, Lever& lever, SiModel& si, SiBath& bath) {
  const Keys springs{{"spring_constant_n_per_m", &lever.spring_constant_n_per_m},
                     {"resonance_hz", &lever.resonance_hz},
                     {"lateral_spring_constant_n_per_m", &lever.lateral_spring_constant_n_per_m}};
  const Keys frequencies{{"omega_v_rad_per_s", &si.omega_v_rad_per_s},
                         {"omega_h_rad_per_s", &si.omega_h_rad_per_s},
                         {"tip_mass_kg", &si.tip_mass_kg}};
  const Keys damping{{"quality_factor", &bath.quality_factor},
                     {"lateral_quality_factor", &bath.lateral_quality_factor},
                     {"kicks_per_tau", &bath.kicks_per_tau}};
  const File file("lever", name, {springs, frequencies, damping});
  const bool by_frequencies = file.has_one_of(frequencies);
  if (by_frequencies && file.has_one_of(springs)) {
    file.refuse("it gives the lever twice: by spring constants and resonance, and by frequencies and tip mass");
  }
  const Keys& constants = by_frequencies ? frequencies : springs;
  file.need(constants);
  file.take(constants);
  file.take(damping);
  const std::vector<ParameterError> faults = by_frequencies ? find_faults(si) : find_faults(lever);
  if (!faults.empty()) file.refuse(describe(faults));
}

void read_surface(const std::string& name, SiModel& si) {
  const Keys keys{{"lattice_spacing_m", &si.lattice_spacing_m}, {"surface_amplitude_m", &si.surface_amplitude_m}};
  const File file("surface", name, {keys});
  file.need(keys);
  file.take(keys);
}

}  // namespace

std::string find_lever_file_fault(const std::string& path) try {
  Lever lever;
  SiModel si;
  SiBath bath;
  read_lever(path, lever, si, bath);
  return {};
} catch (const FileError& error) {
  return error.reason;
}

std::string find_surface_file_fault(const std::string& path) try {
  SiModel si;
  read_surface(path, si);
  return {};
} catch (const FileError& error) {
  return error.reason;
}

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
  if (!o.lever.empty()) read_lever(o.lever, lever, si, bath);
  if (!o.surface.empty()) read_surface(o.surface, si);
  std::vector<ParameterError> faults = set_lever_and_load(lever, o.load_n, si);
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
