#include "afm/units.h"

#include <cmath>
#include <string>

#include "fault_list.h"

namespace afm {

std::vector<ParameterError> find_faults(const SiModel& si) {
  std::vector<ParameterError> faults;
  // wide enough for every real tip, and no product of units overflows; a lattice spacing in nm is none in m
  const auto require_scale = [&](const char* name, double value) {
    if (!(value >= 1e-40 && value <= 1e40))
      faults.emplace_back(name, value, "must be positive, between 1e-40 and 1e40");
  };
  require_scale("omega_v_rad_per_s", si.omega_v_rad_per_s);
  require_scale("omega_h_rad_per_s", si.omega_h_rad_per_s);
  require_scale("tip_mass_kg", si.tip_mass_kg);
  if (!(si.lattice_spacing_m >= 1e-12 && si.lattice_spacing_m <= 1e-4)) {
    faults.emplace_back("lattice_spacing_m", si.lattice_spacing_m, "must be between 1e-12 and 1e-4 m; mica: 5.2e-10");
  }
  const bool scaled = faults.empty();
  const auto rename = [&](const ParameterError& fault) {
    if (fault.name == "H") return faults.emplace_back("surface_amplitude_m", si.surface_amplitude_m, fault.reason);
    if (fault.name == "y0") return faults.emplace_back("rest_height_m", si.rest_height_m, fault.reason);
    if (fault.name == "gamma") return faults.emplace_back("restitution_gamma", si.restitution_gamma, fault.reason);
    if (fault.name == "v_c") return faults.emplace_back("cutoff_speed", si.cutoff_speed, fault.reason);
    return faults.emplace_back("omega_h_rad_per_s", si.omega_h_rad_per_s, fault.reason);
  };
  // if a scale is faulty, check the other parameters with mica's scales, so that all faults are reported at once
  const SiModel mica;
  SiModel judged = si;
  if (!scaled) {
    judged.omega_v_rad_per_s = mica.omega_v_rad_per_s;
    judged.omega_h_rad_per_s = mica.omega_h_rad_per_s;
    judged.lattice_spacing_m = mica.lattice_spacing_m;
    judged.tip_mass_kg = mica.tip_mass_kg;
  }
  for (const ParameterError& fault : find_faults(Units(judged).to_natural(judged))) rename(fault);
  return faults;
}

std::vector<ParameterError> find_faults(const Lever& lever) {
  std::vector<ParameterError> faults;
  const auto require = [&](const char* name, double value) {
    if (!(value >= 1e-12 && value <= 1e12)) {
      faults.emplace_back(name, value, "must be between 1e-12 and 1e12; a lever needs all three of its constants");
    }
  };
  require("spring_constant_n_per_m", lever.spring_constant_n_per_m);
  require("resonance_hz", lever.resonance_hz);
  require("lateral_spring_constant_n_per_m", lever.lateral_spring_constant_n_per_m);
  return faults;
}

void set_lever(const Lever& lever, SiModel& si) {
  si.omega_v_rad_per_s = kTwoPi * lever.resonance_hz;
  si.tip_mass_kg = lever.spring_constant_n_per_m / (si.omega_v_rad_per_s * si.omega_v_rad_per_s);
  si.omega_h_rad_per_s = std::sqrt(lever.lateral_spring_constant_n_per_m / si.tip_mass_kg);
}

std::vector<ParameterError> set_lever_and_load(const Lever& lever, double load_n, SiModel& si) {
  std::vector<ParameterError> faults;
  const SiModel usual;
  const auto forbid = [&](const char* name, double value, double usual_value, const std::string& instead) {
    if (value != usual_value) faults.emplace_back(name, value, "is given beside " + instead + ": give one of them");
  };
  // a model that follows from what was given under another name: a fault of it is named as it was given
  const auto take = [&](const SiModel& changed, const char* follows, const char* given, double value) {
    bool fits = true;
    for (const ParameterError& fault : find_faults(changed)) {
      if (fault.name != follows) continue;
      fits = false;
      faults.emplace_back(given, value, "makes " + fault.name + " = " + number_text(fault.value) + ": " + fault.reason);
    }
    if (fits) si = changed;
  };
  if (lever.is_given()) {
    const char* const constants = "the spring constants and the resonance of a lever";
    forbid("omega_v_rad_per_s", si.omega_v_rad_per_s, usual.omega_v_rad_per_s, constants);
    forbid("omega_h_rad_per_s", si.omega_h_rad_per_s, usual.omega_h_rad_per_s, constants);
    forbid("tip_mass_kg", si.tip_mass_kg, usual.tip_mass_kg, constants);
    const std::vector<ParameterError> wrong = find_faults(lever);
    faults.insert(faults.end(), wrong.begin(), wrong.end());
    if (wrong.empty()) {
      SiModel with_lever = si;
      set_lever(lever, with_lever);
      take(with_lever, "omega_h_rad_per_s", "lateral_spring_constant_n_per_m", lever.lateral_spring_constant_n_per_m);
    }
  }
  if (load_n == 0.0) return faults;
  forbid("rest_height_m", si.rest_height_m, usual.rest_height_m, "load_n");
  if (!std::isfinite(load_n)) {
    faults.emplace_back("load_n", load_n, "must be finite");
  }
  if (!faults.empty()) return faults;  // the load of another lever would be judged
  SiModel loaded = si;
  loaded.rest_height_m = -load_n / spring_constant(si);
  take(loaded, "rest_height_m", "load_n", load_n);
  return faults;
}

double spring_constant(const SiModel& si) { return si.tip_mass_kg * si.omega_v_rad_per_s * si.omega_v_rad_per_s; }

std::vector<ParameterError> find_faults(const SiBath& bath, const Units& units) {
  std::vector<ParameterError> faults;
  for (const ParameterError& fault : find_faults(units.to_natural(bath))) {
    if (fault.name != "temperature") {
      faults.push_back(fault);
      continue;
    }
    const double most = std::floor(kMaxTemperature * units.temperature());
    faults.emplace_back("temperature_k", bath.temperature_k,
                        "must be between 0 and " + number_text(most) + " K: kT is at most " +
                            number_text(kMaxTemperature) + " m_tip a^2/tau^2 of this lever and crystal");
  }
  return faults;
}

Units::Units(const SiModel& si) : a_(si.lattice_spacing_m), tau_(kTwoPi / si.omega_v_rad_per_s), m_(si.tip_mass_kg) {}

Model Units::to_natural(const SiModel& si) const {
  Model model;
  model.frequency_ratio = si.omega_h_rad_per_s / si.omega_v_rad_per_s;
  model.H = si.surface_amplitude_m / a_;
  model.y0 = si.rest_height_m / a_;
  model.gamma = si.restitution_gamma;
  model.v_c = si.cutoff_speed / velocity();
  return model;
}

Bath Units::to_natural(const SiBath& si) const {
  Bath bath;
  bath.temperature = si.temperature_k / temperature();
  bath.quality_factor = si.quality_factor;
  bath.lateral_quality_factor = si.lateral_quality_factor;
  bath.kicks_per_tau = si.kicks_per_tau;
  bath.seed = si.seed;
  return bath;
}

}  // namespace afm
