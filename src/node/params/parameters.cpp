#include "parameters.h"

#include <pwd.h>
#include <ros/master.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <set>
#include <sstream>
#include <utility>

#include "afm/number_text.h"
#include "common/lever_options.h"
#include "table.h"

namespace afm::node {
namespace {

using Value = XmlRpc::XmlRpcValue;

std::string text_of(Value& value) {
  if (value.getType() == Value::TypeString) return '"' + static_cast<std::string&>(value) + '"';
  if (value.getType() == Value::TypeDouble) return number_text(static_cast<double&>(value));
  std::ostringstream text;
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
    return "must be a number, not text; YAML needs a decimal point and a sign in the exponent: 1.0e-4, 1.0e+4";
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
    return "must be a whole number between 0 and 1e15";
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

std::string read(Value& value, std::vector<double>* out) {
  if (value.getType() != Value::TypeArray) return "must be a list of numbers";
  out->resize(static_cast<std::size_t>(value.size()));
  for (int i = 0; i < value.size(); ++i) {
    const std::string wrong = read(value[i], &(*out)[static_cast<std::size_t>(i)]);
    if (!wrong.empty()) return "element " + std::to_string(i) + ": " + wrong;
  }
  return {};
}

// Under a load that holds the tip down in a valley it begins there, unless another initial state is given.
void set_initial_state(Parameters& p) {
  const FreeState usual = Parameters().initial, &given = p.initial;
  const bool is_given = given.phase != usual.phase || given.X != usual.X || given.y != usual.y || given.u != usual.u ||
                        given.w != usual.w;
  const Model model = Units(p.si).to_natural(p.si);
  if (!is_given && is_held_down(model)) p.initial = lowered_tip(model.H);
}

// A slow lever cannot be dragged as fast: the default of the limit gives way.
void set_most_drag(Parameters& p) {
  const double usual = Parameters().max_drag_velocity;
  if (p.max_drag_velocity == usual) p.max_drag_velocity = std::min(usual, most_drag_velocity(p.si));
}

// ~ and ~/... A service of the system has no HOME.
std::string expand_home(const std::string& path) {
  if (path != "~" && path.compare(0, 2, "~/") != 0) return path;
  const char* home = std::getenv("HOME");
  const passwd* user = home == nullptr ? getpwuid(getuid()) : nullptr;
  if (user != nullptr) home = user->pw_dir;
  return home != nullptr ? home + path.substr(1) : path;
}

// Parameters of a node that has its name below ours; not ours in a group of their own, which would have no effect.
bool is_of_another_node(Value& value, const std::set<std::string>& ours) {
  if (value.getType() != Value::TypeStruct) return false;
  return std::none_of(value.begin(), value.end(), [&](const auto& member) { return ours.count(member.first) > 0; });
}

// The levels for model auto, from their file.
void load_levels(Parameters& p, Faults& faults) {
  const auto fault = [&](const std::string& reason) {
    faults.push_back({"level_table", '"' + p.level_table + '"', reason});
  };
  if (p.level_table.empty()) {
    return fault(
        "model auto takes its levels from this file: give config/levels.csv, as emulator.launch does, or one that the "
        "program level_table made");
  }
  std::ifstream file(p.level_table);
  std::stringstream text;
  if (file) text << file.rdbuf();
  if (!file) return fault(std::string("cannot be read: ") + std::strerror(errno));
  try {
    p.levels = std::make_shared<const LevelTable>(text);
  } catch (const std::exception& error) {
    fault(error.what());
  }
}

// A file that lacks a number would leave that of another lever or crystal in force.
void check_files(const Parameters& p, Faults& faults) {
  const auto check = [&](const char* name, const std::string& path, const auto& find_fault) {
    const std::string fault = path.empty() ? "" : find_fault(path);
    if (!fault.empty()) faults.push_back({name, '"' + path + '"', fault});
  };
  check("lever_file", p.lever_file, find_lever_file_fault);
  check("surface_file", p.surface_file, find_surface_file_fault);
}

}  // namespace

Parameters read_parameters(Value tree, Faults& faults) {
  Parameters parameters;
  const bool has_values = tree.getType() == Value::TypeStruct;
  std::set<std::string> known;
  std::string names;
  for_each_parameter(parameters, [&](const char* name, auto& value) {
    known.insert(name);
    names += (names.empty() ? "" : ", ") + std::string(name);
    const std::string wrong = has_values && tree.hasMember(name) ? read(tree[name], &value) : "";
    if (!wrong.empty()) faults.push_back({name, text_of(tree[name]), wrong});
  });
  if (has_values) {
    for (auto& [name, value] : tree) {
      if (known.count(name) > 0 || is_of_another_node(value, known)) continue;
      faults.push_back({name, text_of(value), "there is no such parameter; there are " + names});
    }
  }
  Faults of_values;
  check_files(parameters, of_values);
  add(set_lever_and_load(parameters.lever, parameters.load_n, parameters.si), of_values);
  if (find_faults(parameters.si).empty()) {
    set_initial_state(parameters);
    set_most_drag(parameters);
  }
  parameters.bag_directory = expand_home(parameters.bag_directory);
  parameters.level_table = expand_home(parameters.level_table);
  for (const Fault& fault : find_faults(parameters)) of_values.push_back(fault);
  // what could not be read stands at its default here and adds no fault of its own
  const std::size_t unread = faults.size();
  for (Fault& fault : of_values) {
    const auto has_its_name = [&](const Fault& other) { return other.name == fault.name; };
    const auto end = faults.begin() + static_cast<std::ptrdiff_t>(unread);
    if (std::none_of(faults.begin(), end, has_its_name)) faults.push_back(std::move(fault));
  }
  if (parameters.model == kAuto) load_levels(parameters, faults);
  return parameters;
}

Parameters load_parameters(const ros::NodeHandle& node, Faults& faults) {
  Value tree;
  if (!node.getParam(node.getNamespace(), tree) && !ros::master::check()) {
    faults.push_back({node.getNamespace(), "?", "the parameters cannot be read, as the master does not answer"});
  }
  return read_parameters(tree, faults);
}

}  // namespace afm::node
