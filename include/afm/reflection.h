// The restitution law (paper, section III) and the reflection (Eq. 11), in terms of the gap rate g1 = sqrt(1 + h'^2)
// n.v. Guarantees: the tangential velocity stays to rounding, and the loss is exact to a few ulp even where gamma_eff
// is almost 1.
#pragma once

#include <algorithm>
#include <cmath>

#include "flight.h"

namespace afm {

// The effective restitution gamma_eff: gamma at and above the cutoff, linear up to 1 (elastic) at normal speed 0.
inline double restitution(const Model& model, double normal_speed) {
  if (normal_speed >= model.v_c) return model.gamma;
  return 1.0 - (1.0 - model.gamma) * normal_speed / model.v_c;
}

struct Reflection {
  TipState after;
  double normal_speed;         // |n.v| before the impact [a/tau]. For the hammer model: the gap rate |w - h' u|
  double tangential_velocity;  // t.v, which stays [a/tau]. For the hammer model: u
  double energy_loss;          // (1 - gamma_eff^2) (n.v)^2 / 2 [m_tip a^2/tau^2]
};

// Precondition: `incident` is on the surface. A gap rate above 0 is rounding and counts as 0. Below the cutoff we
// compute 1 - gamma_eff directly, so that no digits cancel.
inline Reflection reflect(const Model& model, double eta, const GapJet<double>& incident) {
  const double g1 = std::min(0.0, incident.g1), h1 = incident.h1, slope = is_free_along_x(model) * h1;
  const double n2 = std::fma(slope, h1, 1.0), inverse_n2 = 1.0 / n2, inverse_n = std::sqrt(n2) * inverse_n2;
  const double u = eta + incident.state.U, speed = -g1 * inverse_n;
  const bool fast = speed >= model.v_c;
  const double loss = fast ? 1.0 - model.gamma : (1.0 - model.gamma) / model.v_c * -g1 * inverse_n;
  const double gamma_eff = fast ? model.gamma : 1.0 - loss, one_plus_gamma = fast ? 1.0 + model.gamma : 2.0 - loss;
  const double after_u = std::fma(slope * g1 * inverse_n2, one_plus_gamma, u);
  return {{wrap_phase(incident.state.phase), incident.state.X, after_u, 0.0, -gamma_eff * g1},
          speed,
          std::fma(slope, std::fma(h1, u, g1), u) * inverse_n,
          0.5 * loss * one_plus_gamma * (speed * speed)};
}

}  // namespace afm
