// How small displacements of the tip are carried along (sections II and IV of the paper). A displacement at one time is
// (dx, dX, du, dy, dw): lab position and velocity, and the extension X = x - xc, as x alone does not know where the
// holder is. On the surface, just after an impact, it is (dx, dX, du, dg1), with the gap rate g1: the height follows
// from the place. The hammer's X and u are its holder's: their rows and columns on the section are 0, so that what is
// left is the Jacobian of its own two dimensions, dx and dg1.
#pragma once

#include <Eigen/Core>
#include <cmath>

#include "afm/flight.h"
#include "afm/model.h"
#include "afm/surface.h"

namespace afm {

template <class T>
using FlowVector = Eigen::Matrix<T, 5, 1>;
template <class T>
using FlowJacobian = Eigen::Matrix<T, 5, 5>;
template <class T>
using SectionJacobian = Eigen::Matrix<T, 4, 4>;

// On the section, or in a slide (dx, dX, du), what a tip held along x cannot do taken out.
template <class T, int N>
Eigen::Matrix<T, N, N> held(const T& is_free_along_x, const Eigen::Matrix<T, N, N>& J) {
  if (is_free_along_x != T(0.0)) return J;
  Eigen::Matrix<T, N, N> H = J;
  for (const int i : {1, 2}) {
    H.row(i).setZero();
    H.col(i).setZero();
  }
  return H;
}

// A flight of duration s (Eq. 9-10), exact; its determinant is 1.
template <class T>
FlowJacobian<T> flight_jacobian(const Mechanics<T>& m, const T& s) {
  const SinCos<T> h = sin_cos_turns(turn_product(m.ratio, s)), v = sin_cos_turns(s);
  FlowJacobian<T> J = FlowJacobian<T>::Identity();
  J(0, 1) = h.cos - T(1.0);
  J(0, 2) = J(1, 2) = h.sin * m.inverse_omega_h;
  J(1, 1) = J(2, 2) = h.cos;
  J(2, 1) = -m.omega_h * h.sin;
  J(3, 3) = J(4, 4) = v.cos;
  J(3, 4) = v.sin * m.inverse_omega_v;
  J(4, 3) = -m.omega_v * v.sin;
  return J;
}

// The velocity in phase space while the tip flies.
template <class T>
FlowVector<T> flight_velocity(const Mechanics<T>& m, const T& eta, const FlightState<T>& q) {
  FlowVector<T> F;
  F << eta + q.U, q.U, -m.omega_h * m.omega_h * q.X, q.W, -m.omega_v * m.omega_v * q.Y;
  return F;
}

// Gradient of the gap y - h(x).
template <class T>
FlowVector<T> gap_gradient(const SurfaceJet<T>& surface) {
  FlowVector<T> G;
  G << -surface.h1, T(0.0), T(0.0), T(1.0), T(0.0);
  return G;
}

// Eq. 2: P carries a displacement along the flow F to where it meets the surface with the gradient G.
template <class T, int N>
Eigen::Matrix<T, N, N> onto_surface(const Eigen::Matrix<T, N, 1>& F, const Eigen::Matrix<T, N, 1>& G) {
  return Eigen::Matrix<T, N, N>::Identity() - F * (G.transpose() / G.dot(F));
}

// Eq. 5: the Jacobian of a map in a flow: onto the surface, through the map, back to one time in the flow after it.
template <class T, int N>
Eigen::Matrix<T, N, N> map_in_flow(const Eigen::Matrix<T, N, 1>& before, const Eigen::Matrix<T, N, 1>& after,
                                   const Eigen::Matrix<T, N, 1>& G, const Eigen::Matrix<T, N, N>& map) {
  return map * onto_surface(before, G) + after * (G.transpose() / G.dot(before));
}

// The outgoing normal speed restitution * speed, and its slope by the incoming one: not the restitution itself below
// the cutoff.
template <class T>
struct RestitutionJet {
  T restitution, slope;
};

template <class T>
RestitutionJet<T> restitution_jet(const Model& model, const T& speed) {
  const T gamma(model.gamma), v_c(model.v_c);
  if (speed >= v_c) return {gamma, gamma};
  const T share = (T(1.0) - gamma) * speed / v_c;
  return {T(1.0) - share, T(1.0) - T(2.0) * share};
}

// An impact: the surface there, and the incident velocities.
template <class T>
struct Incidence {
  SurfaceJet<T> surface;
  T normal_speed;         // -n.v > 0; of the hammer the gap rate
  T tangential_velocity;  // t.v; of the hammer u

  Incidence(const Mechanics<T>& m, const T& eta, const FlightState<T>& q, const T& g1)
      : surface(surface_jet(m.H, q.phase)) {
    using std::sqrt;
    const T slope = m.is_free_along_x * surface.h1, N = sqrt(T(1.0) + slope * slope), u = eta + q.U;
    normal_speed = -g1 / N;
    tangential_velocity = (u + slope * (g1 + slope * u)) / N;
  }
};

// The hammer's: w' = w - (1 + restitution) r, r = w - h'(x) u; u is the holder's.
template <class T>
FlowJacobian<T> hammer_reflection_derivative(const RestitutionJet<T>& law, const Incidence<T>& in) {
  const T gain = T(1.0) + law.slope;
  FlowJacobian<T> R = FlowJacobian<T>::Identity();
  R(4, 0) = gain * in.surface.h2 * in.tangential_velocity;
  R(4, 2) = gain * in.surface.h1;
  R(4, 4) -= gain;
  return R;
}

// Derivative of the reflection (Eq. 11) where it takes place, Eq. 4: velocities by velocities, and by the turn of the
// normal.
template <class T>
FlowJacobian<T> reflection_derivative(const Model& model, const Incidence<T>& in) {
  using std::sqrt;
  if (model.kind == ModelKind::hammer) return hammer_reflection_derivative(restitution_jet(model, in.normal_speed), in);
  const T h1 = in.surface.h1, N2 = T(1.0) + h1 * h1, N = sqrt(N2);
  const RestitutionJet<T> law = restitution_jet(model, in.normal_speed);
  const T turn = in.surface.h2 / N2;  // -t.dn/dx
  const T nx = -h1 / N, ny = T(1.0) / N, tx = ny, ty = -nx;
  const T kick = (T(1.0) + law.restitution) * in.normal_speed, gain = T(1.0) + law.slope;
  FlowJacobian<T> R = FlowJacobian<T>::Identity();
  R(2, 0) = turn * (gain * in.tangential_velocity * nx - kick * tx);
  R(4, 0) = turn * (gain * in.tangential_velocity * ny - kick * ty);
  R(2, 2) -= gain * nx * nx;
  R(2, 4) = R(4, 2) = -gain * nx * ny;
  R(4, 4) -= gain * ny * ny;
  return R;
}

// Eq. 13-16 with the signs put right and the slope of the law: in the frame of tangent and normal at the impact,
// positions before velocities. A_n is the normal acceleration. The determinant is (restitution * slope). Of the
// oscillator.
template <class T>
Eigen::Matrix<T, 4, 4> local_reflection_jacobian(const Model& model, const Incidence<T>& in, const T& A_n) {
  using std::sqrt;
  const T N2 = T(1.0) + in.surface.h1 * in.surface.h1;
  const T k = in.surface.h2 / (N2 * sqrt(N2)), v_n = -in.normal_speed, v_t = in.tangential_velocity;
  const RestitutionJet<T> law = restitution_jet(model, in.normal_speed);
  const T kick = T(1.0) + law.restitution, gain = T(1.0) + law.slope;
  Eigen::Matrix<T, 4, 4> J;
  J << T(1.0), T(0.0), T(0.0), T(0.0),                  //
      T(0.0), -law.restitution, T(0.0), T(0.0),         //
      kick * k * v_n, -kick * k * v_t, T(1.0), T(0.0),  //
      gain * k * v_t, gain * (A_n - k * v_t * v_t) / v_n, T(0.0), -law.slope;
  return J;
}

// From a displacement on the section, at a lab velocity u, to one in the whole phase space.
template <class T>
Eigen::Matrix<T, 5, 4> off_section(const SurfaceJet<T>& surface, const T& u) {
  Eigen::Matrix<T, 5, 4> E = Eigen::Matrix<T, 5, 4>::Zero();
  E(0, 0) = E(1, 1) = E(2, 2) = E(4, 3) = T(1.0);
  E(3, 0) = E(4, 2) = surface.h1;
  E(4, 0) = surface.h2 * u;
  return E;
}

// And back, for a displacement that lies in the surface already (onto_surface).
template <class T>
Eigen::Matrix<T, 4, 5> to_section(const SurfaceJet<T>& surface, const T& u) {
  Eigen::Matrix<T, 4, 5> S = Eigen::Matrix<T, 4, 5>::Zero();
  S(0, 0) = S(1, 1) = S(2, 2) = S(3, 4) = T(1.0);
  S(3, 0) = -surface.h2 * u;
  S(3, 2) = -surface.h1;
  return S;
}

// From one impact to just after the next: a flight that starts on the surface, and ends after s with the gap rate and
// state of `landing`. The determinant (of the hammer that of dx and dg1) is slope * restitution * g1(start) /
// g1(after).
template <class T>
SectionJacobian<T> section_jacobian(const Model& model, const Flight<T>& flight, const T& s, const GapJet<T>& landing) {
  const Mechanics<T>& m = flight.mechanics();
  const FlightState<T>&start = flight.start().state, &end = landing.state;
  const Incidence<T> in(m, flight.eta(), end, landing.g1);
  const T u_start = flight.eta() + start.U, u_end = flight.eta() + end.U, h1 = in.surface.h1;
  const RestitutionJet<T> law = restitution_jet(model, in.normal_speed);
  const T u_after = u_end + m.is_free_along_x * ((T(1.0) + law.restitution) * h1 * landing.g1 / (T(1.0) + h1 * h1));
  const Eigen::Matrix<T, 5, 4> flown = flight_jacobian(m, s) * off_section(surface_jet(m.H, start.phase), u_start);
  const FlowVector<T> F = flight_velocity(m, flight.eta(), end), G = gap_gradient(in.surface);
  const Eigen::Matrix<T, 1, 4> gap = G.transpose() * flown;
  const Eigen::Matrix<T, 5, 4> met = flown - F * (gap / landing.g1);
  const SectionJacobian<T> J = to_section(in.surface, u_after) * (reflection_derivative(model, in) * met);
  return held(m.is_free_along_x, J);
}

}  // namespace afm
