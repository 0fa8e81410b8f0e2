// The restitution law and the reflection (Eq. 11), written in the gap rate, which is what an impact turns round:
// g1 = sqrt(1 + h'^2) n.v.
#pragma once

#include <cmath>

#include "flight.h"

namespace afm {

// gamma at and above the cutoff, linearly up to 1 (elastic) at normal speed 0.
inline double restitution(const Model& model, double normal_speed) {
  if (normal_speed >= model.v_c) return model.gamma;
  return 1.0 - (1.0 - model.gamma) * normal_speed / model.v_c;
}

template <class T>
struct ReflectionOf {
  typename LaunchOf<T>::State after;
  T normal_speed;         // |n.v| before [a/tau]; of the hammer the gap rate, |w - h' u|
  T tangential_velocity;  // t.v, kept [a/tau]; the hammer keeps u
  T energy_loss;          // (1 - gamma_eff^2) (n.v)^2 / 2 [m a^2/tau^2]
};
using Reflection = ReflectionOf<double>;

// What of a model a reflection asks for; `free`: its mobility.
template <class T>
struct ReflectionLaw {
  T gamma, v_c, free;
};

// `incident`: on the surface; a gap rate above 0 is rounding, and taken for 0. The slope is what it brings: only the
// flight that follows has to wait for a sine.
template <class T>
ReflectionOf<T> reflect(const ReflectionLaw<T>& law, const T& eta, const GapJet<T>& incident) {
  using std::min;
  using std::sqrt;
  const T one(1.0), g1 = min(T(0.0), incident.g1), h1 = incident.h1;
  const T slope = law.free * h1, n2 = mul_add(slope, h1, one);
  // products are sooner there than quotients
  const T per_n2 = one / n2, per_n = sqrt(n2) * per_n2, loss_rate = (one - law.gamma) / law.v_c * -g1;
  const T u = eta + incident.state.U, speed = -g1 * per_n;
  // above the cutoff 1 - gamma_eff is exact enough; below it the law gives the small difference itself
  const auto fast = speed >= law.v_c;
  const T loss = either(
      fast, [&] { return T(one - law.gamma); }, [&] { return T(loss_rate * per_n); });
  const T gamma_eff = select(fast, law.gamma, T(one - loss)), turned = select(fast, one + law.gamma, T(2.0) - loss);
  const T after_u = mul_add(T((slope * g1) * per_n2), turned, u);
  return {{wrapped(incident.state.phase), incident.state.X, after_u, T(0.0), -gamma_eff * g1},
          speed,
          mul_add(slope, mul_add(h1, u, g1), u) * per_n,
          T(0.5) * loss * turned * (speed * speed)};
}
inline Reflection reflect(const Model& model, double eta, const GapJet<double>& incident) {
  return reflect(ReflectionLaw<double>{model.gamma, model.v_c, mobility(model)}, eta, incident);
}

}  // namespace afm
