// SI <-> natural units (a, tau, m_tip). Only this file knows the size of a lattice cell.
#pragma once

#include "bath.h"
#include "model.h"

namespace afm {

// The model in SI. Defaults are the paper's values (section V).
struct SiModel {
  double omega_v_rad_per_s = 40e3;
  double omega_h_rad_per_s = 250e3;
  double tip_mass_kg = 408e-12;
  double lattice_spacing_m = 0.52e-9;
  double surface_amplitude_m = 0.05e-9;
  double rest_height_m = 0.0;  // y0, from mid-surface
  double restitution_gamma = 0.7;
  double cutoff_speed = 0.166e-6;  // v_c [m/s]
};

// Every fault, named as in SiModel and in SI.
std::vector<ParameterError> find_faults(const SiModel& si);

// A cantilever as its owner knows it.
struct Lever {
  double spring_constant_n_per_m = 0.0;          // k
  double resonance_hz = 0.0;                     // f0
  double lateral_spring_constant_n_per_m = 0.0;  // k_h, at the tip

  bool is_given() const {
    return spring_constant_n_per_m != 0.0 || resonance_hz != 0.0 || lateral_spring_constant_n_per_m != 0.0;
  }
};

// Every fault, named as in Lever.
std::vector<ParameterError> find_faults(const Lever& lever);

// The springs and the effective mass of a lever: omega_v = 2 pi f0, m = k / omega_v^2, omega_h = sqrt(k_h / m).
void set_lever(const Lever& lever, SiModel& si);

// A lever, if it is given, and a load [N] in the terms of their owner, into the model: the rest height is -load / k.
// Every fault: what is given beside the same in the terms of the model, and a load that is not finite or out of range
// (it is then not set).
std::vector<ParameterError> set_lever_and_load(const Lever& lever, double load_n, SiModel& si);

// The vertical spring constant k = m omega_v^2 [N/m]. A load is -k times the rest height.
double spring_constant(const SiModel& si);

// The heat bath in SI (bath.h); off by default.
struct SiBath {
  double temperature_k = 0.0;
  double quality_factor = 0.0;
  double lateral_quality_factor = 0.0;
  double kicks_per_tau = Bath{}.kicks_per_tau;
  std::uint64_t seed = Bath{}.seed;
};

constexpr double kBoltzmann = 1.380649e-23;  // [J/K] exact by the definition of the kelvin

// Factors from natural units to SI: value_si = value * factor.
class Units {
 public:
  explicit Units(const SiModel& si);

  double length() const { return a_; }                            // m
  double time() const { return tau_; }                            // s
  double velocity() const { return a_ / tau_; }                   // m/s
  double energy() const { return m_ * velocity() * velocity(); }  // J
  double force() const { return energy() / a_; }                  // N
  double friction() const { return m_ / tau_; }                   // kg/s, of K_f

  double temperature() const { return energy() / kBoltzmann; }  // K, of kT

  Model to_natural(const SiModel& si) const;
  Bath to_natural(const SiBath& si) const;

 private:
  double a_, tau_, m_;
};

// Every fault, named as in SiBath and in SI.
std::vector<ParameterError> find_faults(const SiBath& bath, const Units& units);

}  // namespace afm
