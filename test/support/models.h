// The paper's tip on mica but for what a test varies, and where runs begin.
#pragma once

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

// Well above the surface, dragged along with its holder.
inline FreeState start_at(double eta) { return {0.25, 0.0, 0.2, eta, 0.0}; }

}  // namespace afm
