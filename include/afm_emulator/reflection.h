// The restitution law and the reflection (Eq. 11), written in the gap rate, which is what an impact turns round:
// g1 = sqrt(1 + h'^2) n.v.
#pragma once

#include <cmath>

#include "afm_emulator/flight.h"

namespace afm {

// gamma at and above the cutoff, linearly up to 1 (elastic) at normal speed 0.
inline double restitution(const Model& model, double normal_speed) {
  if (normal_speed >= model.v_c) return model.gamma;
  return 1.0 - (1.0 - model.gamma) * normal_speed / model.v_c;
}

struct Reflection {
  TipState after;
  SurfaceJet<double> surface;  // there
  double normal_speed;         // |n.v| before [a/tau]; of the hammer the gap rate, |w - h' u|
  double tangential_velocity;  // t.v, kept [a/tau]; the hammer keeps u
  double energy_loss;          // (1 - gamma_eff^2) (n.v)^2 / 2 [m a^2/tau^2]
};

// `incident`: the state at the impact, gap rate g1 <= 0.
inline Reflection reflect(const Model& model, double eta, const FlightState<double>& incident, double g1) {
  const double phase = wrap_phase(incident.phase);
  const SurfaceJet<double> surface = surface_jet(model.H, phase);
  const double free = mobility(model), n2 = 1.0 + free * surface.h1 * surface.h1;
  const double n = std::sqrt(n2);
  const double u = eta + incident.U, speed = -g1 / n;
  const double gamma_eff = restitution(model, speed);
  // above the cutoff 1 - gamma_eff is exact enough; below it the law gives the small difference itself
  const double loss = speed >= model.v_c ? 1.0 - model.gamma : (1.0 - model.gamma) * speed / model.v_c;
  Reflection r;
  r.surface = surface;
  r.after = {phase, incident.X, u + free * (1.0 + gamma_eff) * surface.h1 * g1 / n2, 0.0, -gamma_eff * g1};
  r.normal_speed = speed;
  r.tangential_velocity = (u + free * surface.h1 * (g1 + surface.h1 * u)) / n;
  r.energy_loss = 0.5 * loss * (1.0 + gamma_eff) * speed * speed;
  return r;
}

}  // namespace afm
