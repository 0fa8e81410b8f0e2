// The reaction along the reference slide, and the coefficients of the displacement from it (docs/algorithm.md,
// "Chatter"). For numbers and for dual numbers. The hammer is held along x, so its slope counts as zero.
#pragma once

#include <algorithm>
#include <cmath>

#include "afm/detail/slide_series.h"
#include "afm/spring_constants.h"
#include "afm/surface.h"

namespace afm::detail {

template <class T>
struct ReferenceForces {
  T P, P1, P2;  // reaction normal to the surface [a/tau^2], its first two time derivatives
  T K;          // growth of the reaction with the distance from the surface [1/tau^2]
  T turn;       // turn rate of the surface under the tip: curvature times speed [rad/tau]
  T c_height;   // of rho in the acceleration along the surface: minus dP/ds [1/tau^2]
  T c_sigma;    // of -sigma in the acceleration along the surface [1/tau^2]
  T dx_dsigma;  // displacement along x for one along the surface
  T dx_drho;    // displacement along x for a distance from the surface
};

// They control steps and ends only: no derivatives by the start.
struct ChangeRates {
  double change;   // relative rate of change of P: |P'/P| or sqrt(|P''/P|) [1/tau]
  double fastest;  // the larger of that and the rate of the slope, |u|, and of the springs [1/tau]
};
template <class T>
inline ChangeRates change_rates(const SpringConstants<T>& m, const T& u, const ReferenceForces<T>& f) {
  const double p1 = static_cast<double>(f.P1) / static_cast<double>(f.P);
  const double change = std::sqrt(std::max(p1 * p1, std::abs(static_cast<double>(f.P2) / static_cast<double>(f.P))));
  return {change, std::max({change, std::abs(static_cast<double>(u)), static_cast<double>(m.ratio), 1.0})};
}

// a = N P is the acceleration towards the surface of a tip that does not touch it, N^2 = 1 + s^2; lambda = a/N^2 is the
// reaction along y. The digit at the end of a name counts time derivatives. But h1 to h4 are derivatives of h by x, and
// u2, N2 are squares.
template <class T>
inline ReferenceForces<T> reference_forces(const SpringConstants<T>& m, const T& eta, const SlideState<T>& q) {
  using std::sqrt;
  const SurfaceJet<T> h = surface_jet(m.H, q.phase);
  const T free = m.is_free_along_x, wh2 = m.omega_h * m.omega_h, wv2 = m.omega_v * m.omega_v;
  const T h1 = h.h1, h2 = h.h2, h3 = h.h3, h4 = -wv2 * h2;  // omega_v is the wave number of the surface
  const T u = q.u, u2 = u * u, X = q.X, X1 = u - eta;
  const T s = free * h1, s1 = free * h2 * u, N2 = 1.0 + s * s, inverse_N2 = 1.0 / N2, inverse_N = sqrt(inverse_N2);

  const T a = h2 * u2 - wh2 * h1 * X + wv2 * (h.h - m.y0), lambda = a * inverse_N2, x2 = -wh2 * X - s * lambda;
  const T a1 = u * (h3 * u2 + 2.0 * h2 * x2 + wv2 * h1) - wh2 * (h2 * u * X + h1 * X1);
  const T lambda1 = (a1 - 2.0 * s * s1 * lambda) * inverse_N2, x3 = -wh2 * X1 - s1 * lambda - s * lambda1;
  const T a2 = u2 * (h4 * u2 + 5.0 * h3 * x2) + 2.0 * h2 * (x2 * x2 + u * x3) + wv2 * (h2 * u2 + h1 * x2) -
               wh2 * ((h3 * u2 + h2 * x2) * X + 2.0 * h2 * u * X1 + h1 * x2);

  // turn = (arctan s)', L1 = (ln N)' = s turn
  const T turn = s1 * inverse_N2, turn1 = free * (h3 * u2 + h2 * x2) * inverse_N2 - 2.0 * s * turn * turn;
  const T L1 = s * turn, L2 = s1 * turn + s * turn1;
  ReferenceForces<T> f;
  f.P = a * inverse_N;
  f.P1 = a1 * inverse_N - f.P * L1;
  f.P2 = (a2 - 2.0 * a1 * L1) * inverse_N + f.P * (L1 * L1 - L2);
  f.turn = turn;
  f.K = 3.0 * turn * turn + (wh2 * s * s + wv2) * inverse_N2;

  // curvature kappa, kappa_s, c' and c^2
  const T kappa = free * h2 * inverse_N2 * inverse_N;
  const T kappa_s = free * (h3 - 3.0 * s * h2 * h2 * inverse_N2) * inverse_N2 * inverse_N2;
  const T c1 = (x2 + L1 * u) * N2 * inverse_N, c_squared = u2 * N2;
  f.c_height = s * (wh2 - wv2) * inverse_N2 - kappa * c1 - kappa_s * c_squared;
  f.c_sigma = (wh2 + wv2 * s * s) * inverse_N2 - kappa * (kappa * c_squared - f.P);
  f.dx_dsigma = free * inverse_N;
  f.dx_drho = -s * inverse_N;
  return f;
}

}  // namespace afm::detail
