#include "parameters.h"

#include <cmath>
#include <map>
#include <sstream>
#include <utility>
#include <variant>

namespace afm::node {
namespace {

using Field = std::variant<double*, std::uint64_t*, bool*, std::string*>;

// diagnostic_updater reads these in our namespace
constexpr const char* kForeignNames[] = {"diagnostic_period", "diagnostic_updater_use_fqn"};

std::map<std::string, Field> fields_of(Parameters& p) {
  return {{"omega_v_rad_per_s", &p.si.omega_v_rad_per_s},
          {"omega_h_rad_per_s", &p.si.omega_h_rad_per_s},
          {"tip_mass_kg", &p.si.tip_mass_kg},
          {"lattice_spacing_m", &p.si.lattice_spacing_m},
          {"surface_amplitude_m", &p.si.surface_amplitude_m},
          {"rest_height_m", &p.si.rest_height_m},
          {"restitution_gamma", &p.si.restitution_gamma},
          {"cutoff_speed", &p.si.cutoff_speed},
          {"temperature_k", &p.bath.temperature_k},
          {"quality_factor", &p.bath.quality_factor},
          {"lateral_quality_factor", &p.bath.lateral_quality_factor},
          {"kicks_per_tau", &p.bath.kicks_per_tau},
          {"seed", &p.bath.seed},
          {"model", &p.model},
          {"tolerance", &p.tolerance},
          {"tolerance_of", &p.tolerance_of},
          {"level_table", &p.level_table},
          {"drag_velocity", &p.drag_velocity},
          {"max_drag_velocity", &p.max_drag_velocity},
          {"initial_phase", &p.initial.phase},
          {"initial_extension", &p.initial.X},
          {"initial_height", &p.initial.y},
          {"initial_u", &p.initial.u},
          {"initial_w", &p.initial.w},
          {"time_scale", &p.time_scale},
          {"batch_rate_hz", &p.batch_rate_hz},
          {"sample_rate_hz", &p.sample_rate_hz},
          {"friction_window_tau", &p.friction_window_tau},
          {"command_timeout_s", &p.command_timeout_s},
          {"impact_budget", &p.impact_budget},
          {"contact_tolerance", &p.contact_tolerance},
          {"checkpoint_interval_s", &p.checkpoint_interval_s},
          {"record", &p.record},
          {"bag_directory", &p.bag_directory},
          {"disk_reserve_mb", &p.disk_reserve_mb},
          {"compression", &p.compression},
          {"split_size_mb", &p.split_size_mb},
          {"split_duration_s", &p.split_duration_s}};
}

std::string known_names(const std::map<std::string, Field>& fields) {
  std::string names;
  for (const auto& [name, field] : fields) names += (names.empty() ? "" : ", ") + name;
  return names;
}

using Value = XmlRpc::XmlRpcValue;

std::string text_of(Value& value) {
  if (value.getType() == Value::TypeString) return '"' + static_cast<std::string&>(value) + '"';
  std::ostringstream text;
  text.precision(17);
  text << value;
  return text.str();
}

// Each returns what is wrong with the value, or nothing.

std::string read(Value& value, double* out) {
  if (value.getType() == Value::TypeInt) {
    *out = static_cast<int&>(value);
    return {};
  }
  if (value.getType() == Value::TypeString) {
    return "must be a number, not text; YAML reads 1e-4 as text: write 1.0e-4";
  }
  if (value.getType() != Value::TypeDouble) return "must be a number";
  *out = static_cast<double&>(value);
  return {};
}

std::string read(Value& value, std::uint64_t* out) {
  constexpr double kMost = 1e15;  // above it not every double is the whole number it was given as
  double number = 0.0;
  const std::string wrong = read(value, &number);
  if (!wrong.empty()) return wrong;
  if (!(number >= 0.0 && number <= kMost && number == std::floor(number)))
    return "must be a whole number, not negative";
  *out = static_cast<std::uint64_t>(number);
  return {};
}

std::string read(Value& value, bool* out) {
  if (value.getType() != Value::TypeBoolean) return "must be true or false";
  *out = static_cast<bool&>(value);
  return {};
}

std::string read(Value& value, std::string* out) {
  if (value.getType() != Value::TypeString) return "must be text";
  *out = static_cast<std::string&>(value);
  return {};
}

bool is_foreign(const std::string& name) {
  for (const char* foreign : kForeignNames) {
    if (name == foreign) return true;
  }
  return false;
}

}  // namespace

std::string describe(const Faults& faults) {
  std::string text;
  for (const Fault& fault : faults) {
    text += (text.empty() ? "" : "\n") + fault.name + " = " + fault.value + ": " + fault.reason;
  }
  return text;
}

Parameters read_parameters(Value tree, Faults& faults) {
  Parameters parameters;
  const auto fields = fields_of(parameters);
  if (tree.getType() == Value::TypeStruct) {
    for (auto& [name, value] : tree) {
      const auto field = fields.find(name);
      if (field != fields.end()) {
        const std::string wrong = std::visit([&v = value](auto* out) { return read(v, out); }, field->second);
        if (!wrong.empty()) faults.push_back({name, text_of(value), wrong});
      } else if (!is_foreign(name)) {
        faults.push_back({name, text_of(value), "there is no such parameter; there are " + known_names(fields)});
      }
    }
  }
  // what could not be read stands at its default here and adds no fault of its own
  for (Fault& fault : find_faults(parameters)) faults.push_back(std::move(fault));
  if (parameters.model == kAuto) load_levels(parameters, faults);
  return parameters;
}

Parameters load_parameters(const ros::NodeHandle& node, Faults& faults) {
  Value tree;
  node.getParam(node.getNamespace(), tree);
  return read_parameters(tree, faults);
}

}  // namespace afm::node
