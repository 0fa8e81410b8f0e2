#include "si_options.h"

#include <cstdlib>
#include <map>
#include <stdexcept>

#include "afm/number_text.h"

namespace afm {
namespace {

// The options of all tools that --si takes in SI. --to is a drag velocity or a cutoff, or not taken.
const std::map<std::string, Quantity> kQuantityOf{
    {"amplitude", Quantity::length},        {"cutoff", Quantity::velocity},
    {"drag-velocity", Quantity::velocity},  {"duration", Quantity::time},
    {"friction-duration", Quantity::time},  {"rest-height", Quantity::length},
    {"temperature", Quantity::temperature}, {"to", Quantity::velocity},
    {"transient", Quantity::time}};

const std::map<Quantity, const char*> kSiUnit{
    {Quantity::length, "m"}, {Quantity::time, "s"}, {Quantity::velocity, "m/s"}, {Quantity::temperature, "K"}};

}  // namespace

void add_si_options(CommandLine& app, SiOptions& o) {
  app.flag(
      "si", o.on,
      "options with a unit in brackets are given in SI (m, s, m/s, K), but for --eta; columns are printed in SI, and\n"
      "their names end in the unit, such as k_f_kg_per_s. Defaults stay what they are");
  app.option("lattice-spacing", o.scale.lattice_spacing_m, "a of --si, in m", kPositive);
  app.option("omega-v", o.scale.omega_v_rad_per_s, "vertical angular frequency of --si, in rad/s; tau = 2 pi / omega_v",
             kPositive);
  app.option("tip-mass", o.scale.tip_mass_kg, "m_tip of --si, in kg", kPositive);
}

bool has_drag_velocity(const CommandLine& app, const SiOptions& o) {
  if (!app.is_given("drag-velocity")) return false;
  if (!o.on) throw std::invalid_argument("drag-velocity: is taken only with --si");
  if (app.is_given("eta")) throw std::invalid_argument("drag-velocity: is taken in place of --eta, not beside it");
  return true;
}

Units checked_units(const CommandLine& app, const SiOptions& o) {
  for (const char* name : kScaleOptions) {
    if (app.is_given(name) && !o.on) throw std::invalid_argument(std::string(name) + ": has a meaning only with --si");
  }
  std::vector<ParameterError> faults;
  for (const ParameterError& fault : find_faults(o.scale)) {
    if (fault.name == "lattice_spacing_m") faults.emplace_back(kScaleOptions[0], fault.value, fault.reason);
    if (fault.name == "omega_v_rad_per_s") faults.emplace_back(kScaleOptions[1], fault.value, fault.reason);
    if (fault.name == "tip_mass_kg") faults.emplace_back(kScaleOptions[2], fault.value, fault.reason);
  }
  if (!faults.empty()) throw std::invalid_argument(describe(faults));
  return Units(o.scale);
}

std::vector<ParameterError> as_given(const CommandLine& app, const SiOptions& o,
                                     const std::vector<ParameterError>& faults) {
  constexpr int kDigits = 14, kFew = 4;
  std::vector<ParameterError> given;
  for (const ParameterError& fault : faults) {
    const std::string name = fault.name == "eta" && app.is_given("drag-velocity") ? "drag-velocity" : fault.name;
    const auto quantity = kQuantityOf.find(name);
    if (!o.on || !app.is_given(name) || quantity == kQuantityOf.end()) {
      given.push_back(fault);
      continue;
    }
    const double unit = si_factor(quantity->second, Units(o.scale));
    given.emplace_back(name, std::strtod(rounded_text(fault.value * unit, kDigits).c_str(), nullptr),
                       fault.reason + " (in natural units, where 1 is " + rounded_text(unit, kFew) + " " +
                           kSiUnit.at(quantity->second) + ")");
  }
  return given;
}

TableUnits table_units(const SiOptions& o) { return o.on ? TableUnits::into_si(Units(o.scale)) : TableUnits::plain(); }

void take_si(const CommandLine& app, const SiOptions& o, const std::string& name, std::vector<double>& values) {
  if (!o.on || !app.is_given(name)) return;
  const double unit = si_factor(kQuantityOf.at(name), Units(o.scale));
  for (double& value : values) value /= unit;
}

void take_si(const CommandLine& app, const SiOptions& o, const std::string& name, double& value) {
  std::vector<double> values{value};
  take_si(app, o, name, values);
  value = values.front();
}

}  // namespace afm
