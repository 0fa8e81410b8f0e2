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

template <class T>
struct ReflectionOf {
  typename LaunchOf<T>::State after;
  SurfaceJet<T> surface;  // there
  T normal_speed;         // |n.v| before [a/tau]; of the hammer the gap rate, |w - h' u|
  T tangential_velocity;  // t.v, kept [a/tau]; the hammer keeps u
  T energy_loss;          // (1 - gamma_eff^2) (n.v)^2 / 2 [m a^2/tau^2]
};
using Reflection = ReflectionOf<double>;

// What of a model a reflection asks for; `free`: its mobility.
template <class T>
struct ReflectionLaw {
  T H, gamma, v_c, free;
};

template <class T>
ReflectionOf<T> reflect(const ReflectionLaw<T>& law, const T& eta, const FlightState<T>& incident, const T& g1) {
  using std::sqrt;
  const T phase = wrapped(incident.phase), one(1.0), free = law.free;
  const SurfaceJet<T> surface = surface_jet(law.H, phase);
  const T n2 = one + free * surface.h1 * surface.h1;
  // products are sooner there than quotients
  const T per_n2 = one / n2, per_n = sqrt(n2) * per_n2, loss_slope = (one - law.gamma) / law.v_c;
  const T u = eta + incident.U, speed = -g1 * per_n;
  // above the cutoff 1 - gamma_eff is exact enough; below it the law gives the small difference itself
  const auto fast = speed >= law.v_c;
  const T loss = either(
      fast, [&] { return T(one - law.gamma); }, [&] { return T(loss_slope * speed); });
  const T gamma_eff = select(fast, law.gamma, T(one - loss));
  return {{phase, incident.X, u + (free * surface.h1 * per_n2) * ((one + gamma_eff) * g1), T(0.0), -gamma_eff * g1},
          surface,
          speed,
          (u + free * surface.h1 * (g1 + surface.h1 * u)) * per_n,
          T(0.5) * loss * (one + gamma_eff) * speed * speed};
}

// `incident`: the state at the impact, gap rate g1 <= 0.
inline Reflection reflect(const Model& model, double eta, const FlightState<double>& incident, double g1) {
  return reflect(ReflectionLaw<double>{model.H, model.gamma, model.v_c, mobility(model)}, eta, incident, g1);
}

}  // namespace afm
