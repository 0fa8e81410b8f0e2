// Jacobians of flights and impacts (sections II and IV of the paper). A displacement at one time is (dx, dX, du, dy,
// dw): lab position and velocity, and the extension X = x - xc, because x does not determine the position of the
// holder. On the section of impacts it is (dx, dX, du, dg1), with the gap rate g1 just after the impact; the height
// follows from x. The hammer's X and u are those of its holder: their rows and columns are 0, and dx and dg1 are left.
// Guarantee: exact derivatives, to rounding.
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

// Sets the rows and columns of X and u to 0 for the hammer, on the section or in a slide (dx, dX, du).
template <class T, int N>
Eigen::Matrix<T, N, N> without_held_directions(const T& is_free_along_x, const Eigen::Matrix<T, N, N>& J) {
  if (is_free_along_x != T(0.0)) return J;
  Eigen::Matrix<T, N, N> H = J;
  for (const int i : {1, 2}) {
    H.row(i).setZero();
    H.col(i).setZero();
  }
  return H;
}

// A flight of duration s [tau] (Eq. 9-10). Its determinant is 1.
template <class T>
FlowJacobian<T> flight_jacobian(const SpringConstants<T>& m, const T& s) {
  using detail::sin_cos_turns;
  using detail::turn_product;
  const detail::SinCos<T> h = sin_cos_turns(turn_product(m.ratio, s)), v = sin_cos_turns(s);
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

// The velocity in phase space during a flight.
template <class T>
FlowVector<T> flight_velocity(const SpringConstants<T>& m, const T& eta, const FlightState<T>& q) {
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

// The restitution, and the derivative of the outgoing normal speed by the incoming one. Below the cutoff the two
// differ.
template <class T>
struct RestitutionJet {
  T restitution, slope;
};

template <class T>
RestitutionJet<T> restitution_jet(const Model& model, const T& speed) {
  const T gamma(model.gamma), v_c(model.v_c);
  if (v_c <= speed) return {gamma, gamma};
  const T share = (T(1.0) - gamma) * speed / v_c;
  return {T(1.0) - share, T(1.0) - T(2.0) * share};
}

// An impact: the surface there, and the incident velocities.
template <class T>
struct Incidence {
  SurfaceJet<T> surface;
  T normal_speed;         // -n.v > 0. For the hammer model: the gap rate
  T tangential_velocity;  // t.v. For the hammer model: u

  Incidence(const SpringConstants<T>& m, const T& eta, const FlightState<T>& q, const T& g1)
      : surface(surface_jet(m.H, q.phase)) {
    using std::sqrt;
    const T slope = m.is_free_along_x * surface.h1, N = sqrt(T(1.0) + slope * slope), u = eta + q.U;
    normal_speed = -g1 / N;
    tangential_velocity = (u + slope * (g1 + slope * u)) / N;
  }
};

// The reflection of the hammer: w -> w - (1 + restitution) r with r = w - h'(x) u; u is that of the holder.
template <class T>
FlowJacobian<T> hammer_reflection_derivative(const RestitutionJet<T>& law, const Incidence<T>& in) {
  const T gain = T(1.0) + law.slope;
  FlowJacobian<T> R = FlowJacobian<T>::Identity();
  R(4, 0) = gain * in.surface.h2 * in.tangential_velocity;
  R(4, 2) = gain * in.surface.h1;
  R(4, 4) -= gain;
  return R;
}

// The derivative of the reflection (Eq. 11) at its place, Eq. 4: velocities by velocities, and by the rotation of the
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

// From a displacement on the section, at a lab velocity u, to one in the whole phase space.
template <class T>
Eigen::Matrix<T, 5, 4> off_section(const SurfaceJet<T>& surface, const T& u) {
  Eigen::Matrix<T, 5, 4> E = Eigen::Matrix<T, 5, 4>::Zero();
  E(0, 0) = E(1, 1) = E(2, 2) = E(4, 3) = T(1.0);
  E(3, 0) = E(4, 2) = surface.h1;
  E(4, 0) = surface.h2 * u;
  return E;
}

// And back. Precondition: the displacement lies in the surface (Eq. 2).
template <class T>
Eigen::Matrix<T, 4, 5> to_section(const SurfaceJet<T>& surface, const T& u) {
  Eigen::Matrix<T, 4, 5> S = Eigen::Matrix<T, 4, 5>::Zero();
  S(0, 0) = S(1, 1) = S(2, 2) = S(3, 4) = T(1.0);
  S(3, 0) = -surface.h2 * u;
  S(3, 2) = -surface.h1;
  return S;
}

// From one impact to just after the next: a flight that starts on the surface and ends after s [tau] with the incident
// state `landing`. The determinant (of the hammer: of dx and dg1) is slope * restitution * g1(start) / g1(after).
template <class T>
SectionJacobian<T> section_jacobian(const Model& model, const Flight<T>& flight, const T& s, const GapJet<T>& landing) {
  const SpringConstants<T>& m = flight.springs();
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
  return without_held_directions(m.is_free_along_x, J);
}

}  // namespace afm
