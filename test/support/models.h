// The paper's tip on mica but for what a test varies, and where runs begin.
#pragma once

#include "afm/bath.h"
#include "afm/model.h"
#include "afm/state.h"

namespace afm {

inline Model model_with(double gamma, double v_c, ModelKind kind = ModelKind::oscillator) {
  Model model;
  model.kind = kind;
  model.gamma = gamma;
  model.v_c = v_c;
  return model;
}
inline Model model_with_cutoff(double v_c) { return model_with(Model().gamma, v_c); }
inline Model hammer(double gamma = 0.7, double v_c = 0.05) { return model_with(gamma, v_c, ModelKind::hammer); }

inline Bath bath_of(double temperature, double quality_factor, double kicks_per_tau = 2.0) {
  Bath bath;
  bath.temperature = temperature;
  bath.quality_factor = quality_factor;
  bath.kicks_per_tau = kicks_per_tau;
  return bath;
}

// K_f at even eta: two impacts per tau, each at mid-height of the rising flank. The horizontal frequency is not in it:
// it bends the flights, not the impacts.
inline double even_K_f(double gamma) {
  const double s = kTwoPi * Model().H;
  return 4.0 * (1.0 + gamma) / (1.0 - gamma) * s * s / (1.0 + s * s);
}

// Well above the surface, dragged along with its holder.
inline FreeState start_at(double eta) { return {0.25, 0.0, 0.2, eta, 0.0}; }

}  // namespace afm
