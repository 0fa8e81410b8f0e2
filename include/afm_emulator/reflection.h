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
  const T slope = free * surface.h1, n2 = mul_add(slope, surface.h1, one);
  // products are sooner there than quotients
  const T per_n2 = one / n2, per_n = sqrt(n2) * per_n2, loss_slope = (one - law.gamma) / law.v_c;
  const T u = eta + incident.U, speed = -g1 * per_n;
  // above the cutoff 1 - gamma_eff is exact enough; below it the law gives the small difference itself
  const auto fast = speed >= law.v_c;
  const T loss = either(
      fast, [&] { return T(one - law.gamma); }, [&] { return T(loss_slope * speed); });
  const T gamma_eff = select(fast, law.gamma, T(one - loss)), turned = select(fast, one + law.gamma, T(2.0) - loss);
  return {{phase, incident.X, mul_add(T((slope * g1) * per_n2), turned, u), T(0.0), -gamma_eff * g1},
          surface,
          speed,
          mul_add(slope, mul_add(surface.h1, u, g1), u) * per_n,
          T(0.5) * loss * turned * (speed * speed)};
}

// `incident`: the state at the impact, gap rate g1 <= 0.
inline Reflection reflect(const Model& model, double eta, const FlightState<double>& incident, double g1) {
  return reflect(ReflectionLaw<double>{model.H, model.gamma, model.v_c, mobility(model)}, eta, incident, g1);
}

}  // namespace afm
