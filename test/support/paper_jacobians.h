// The Jacobians as the paper writes them (Eq. 2, 5 and 13-16), which the tests compare with those of the library.
#pragma once

#include <Eigen/Core>
#include <cmath>

#include "afm/dynamics/jacobian.h"

namespace afm {

// Eq. 2: the projection along the flow F onto the surface with the gradient G.
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

// Eq. 13-16 with corrected signs and with the slope of the law, in the frame of tangent and normal at the impact,
// positions before velocities. A_n is the normal acceleration. The determinant is restitution * slope. For the
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

}  // namespace afm
