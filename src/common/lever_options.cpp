#include "lever_options.h"

#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <regex>
#include <set>
#include <stdexcept>
#include <vector>

namespace afm {
namespace {

namespace fs = std::filesystem;

constexpr const char* kTwice[][2] = {{"lever", "frequency-ratio"}, {"surface", "amplitude"}, {"load", "rest-height"}};

std::string names_in(const fs::path& folder) {
  std::string names;
  for (const auto& entry : fs::directory_iterator(folder)) names += " " + entry.path().stem().string();
  return names;
}

// option: lever or surface; name: of one that is shipped, or a path that ends in .yaml.
fs::path path_of(const std::string& option, const std::string& name) {
  const fs::path folder = config_folder() / (option + "s");
  const fs::path path = fs::path(name).extension() == ".yaml" ? fs::path(name) : folder / (name + ".yaml");
  if (!fs::exists(path)) throw std::invalid_argument("there is no such file, nor one of" + names_in(folder));
  if (fs::is_directory(path)) throw std::invalid_argument("it is a folder, not a file");
  return path;
}

// Whether ROS reads the same number: YAML 1.1 takes 013 for octal, and 2e-1, +.5 or a quoted number for text.
bool is_number(const YAML::Node& node) {
  static const std::regex kNumber(R"([-+]?(0|[1-9]\d*|\d+\.\d*([eE][-+]\d+)?)|\.\d+([eE][-+]\d+)?)");
  return node.IsScalar() && node.Tag() == "?" && std::regex_match(node.Scalar(), kNumber);
}

// Reads the file of a lever or a surface: numbers by their keys. Returns the keys that are there. Throws
// std::invalid_argument where it is no such file, or has a key that is not known.
std::set<std::string> read(const std::string& option, const std::string& name,
                           const std::map<std::string, double*>& known) {
  std::set<std::string> keys;
  try {
    const YAML::Node root = YAML::LoadFile(path_of(option, name).string());
    if (!root.IsMap()) throw std::invalid_argument("it must hold lines of a key and a number");
    for (const auto& entry : root) {
      const std::string key = entry.first.as<std::string>();
      const auto number = known.find(key);
      if (number == known.end()) throw std::invalid_argument("it says nothing of a " + option + " by its " + key);
      if (!is_number(entry.second))
        throw std::invalid_argument(key + " must be a number as ROS reads it, such as 13000.0 or 1.3e+4");
      if (!keys.insert(key).second) throw std::invalid_argument("it has " + key + " twice");
      *number->second = entry.second.as<double>();
    }
  } catch (const YAML::Exception& fault) {
    throw std::invalid_argument(fault.what());
  }
  return keys;
}

void need(const std::set<std::string>& keys, const std::vector<std::string>& needed) {
  for (const std::string& key : needed) {
    if (keys.count(key) == 0) throw std::invalid_argument("it lacks " + key);
  }
}

// By its springs, or by its frequencies as the model has them.
void read_lever(const std::string& name, Lever& lever, SiModel& si, SiBath& bath) {
  const std::vector<std::string> springs{"spring_constant_n_per_m", "resonance_hz", "lateral_spring_constant_n_per_m"};
  const std::vector<std::string> frequencies{"omega_v_rad_per_s", "omega_h_rad_per_s", "tip_mass_kg"};
  const std::set<std::string> keys = read("lever", name,
                                          {{springs[0], &lever.spring_constant_n_per_m},
                                           {springs[1], &lever.resonance_hz},
                                           {springs[2], &lever.lateral_spring_constant_n_per_m},
                                           {frequencies[0], &si.omega_v_rad_per_s},
                                           {frequencies[1], &si.omega_h_rad_per_s},
                                           {frequencies[2], &si.tip_mass_kg},
                                           {"quality_factor", &bath.quality_factor},
                                           {"lateral_quality_factor", &bath.lateral_quality_factor},
                                           {"kicks_per_tau", &bath.kicks_per_tau}});
  const auto is_there = [&](const std::string& key) { return keys.count(key) > 0; };
  const bool by_frequencies = std::any_of(frequencies.begin(), frequencies.end(), is_there);
  if (by_frequencies && std::any_of(springs.begin(), springs.end(), is_there)) {
    throw std::invalid_argument(
        "it gives the lever twice: by spring constants and resonance, and by frequencies and tip mass");
  }
  need(keys, by_frequencies ? frequencies : springs);
  const std::vector<ParameterError> faults = by_frequencies ? find_faults(si) : find_faults(lever);
  if (!faults.empty()) throw std::invalid_argument(describe(faults));
}

void read_surface(const std::string& name, SiModel& si) {
  need(read("surface", name,
            {{"lattice_spacing_m", &si.lattice_spacing_m}, {"surface_amplitude_m", &si.surface_amplitude_m}}),
       {"lattice_spacing_m", "surface_amplitude_m"});
}

template <class Read>
std::string fault_of(const Read& read_file) try {
  read_file();
  return {};
} catch (const std::invalid_argument& fault) {
  return fault.what();
}

}  // namespace

fs::path config_folder() {
  const fs::path folder = fs::read_symlink("/proc/self/exe").parent_path();  // PREFIX/bin, or PREFIX/lib/afm_emulator
  for (const fs::path& prefix : {folder.parent_path(), folder.parent_path().parent_path()}) {
    if (fs::exists(prefix / "share/afm_emulator/config")) return prefix / "share/afm_emulator/config";
  }
  return AFM_CONFIG;
}

std::string find_lever_file_fault(const std::string& path) {
  Lever lever;
  SiModel si;
  SiBath bath;
  return fault_of([&] { read_lever(path, lever, si, bath); });
}

std::string find_surface_file_fault(const std::string& path) {
  SiModel si;
  return fault_of([&] { read_surface(path, si); });
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
  for (const std::string option : kScaleOptions) {
    if (!app.is_given(option)) continue;
    throw std::invalid_argument(
        option + ": is that of --lever and --surface, or the paper's; another one goes into a .yaml of your own");
  }
  Lever lever;
  const auto check = [](const std::string& option, const std::string& name, const std::string& fault) {
    if (!fault.empty()) throw std::invalid_argument(option + " = " + name + ": " + fault);
  };
  // an empty name is refused: it may be a variable of a shell that is not set
  if (app.is_given("lever")) {
    check("lever", o.lever, fault_of([&] {
            read_lever(o.lever, lever, si, bath);
            const std::vector<ParameterError> faults = find_faults(Units(SiModel{}).to_natural(bath));
            if (!faults.empty()) throw std::invalid_argument(describe(faults));
          }));
  }
  if (app.is_given("surface")) check("surface", o.surface, fault_of([&] { read_surface(o.surface, si); }));
  std::vector<ParameterError> faults = set_lever_and_load(lever, o.load_n, si);
  if (faults.empty()) faults = find_faults(si);
  for (ParameterError& fault : faults) {
    if (fault.name == "load_n") fault = ParameterError("load", fault.value, fault.reason);
  }
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

std::optional<LeverScene> take_lever(const CommandLine& app, const LeverOptions& options, SiOptions& si) {
  if (!LeverOptions::are_given(app)) return {};
  if (!si.on) throw std::invalid_argument("lever, surface, load: have a meaning only with --si");
  LeverScene scene(app, options);
  si.scale = scene.si;
  return scene;
}

}  // namespace afm
