// The reaction along the reference slide, and what displaces a bouncing tip from it (docs/algorithm.md, "Chatter").
// For numbers and for dual numbers. The hammer is held along x: its slope counts as zero, only the reaction acts.
#pragma once

#include <algorithm>
#include <cmath>

#include "afm/detail/mechanics.h"
#include "afm/detail/multiversion.h"
#include "afm/detail/slide_series.h"
#include "afm/surface.h"

namespace afm {

template <class T>
struct ReferenceForces {
  T P, P1, P2;    // reaction normal to the surface [a/tau^2], its first two time derivatives
  T K;            // growth of the reaction with the distance from the surface [1/tau^2]
  T turn;         // turn rate of the surface under the tip: curvature times speed [rad/tau]
  T c_height;     // of rho in the acceleration along the surface: minus dP/ds [1/tau^2]
  T c_sigma;      // of -sigma in the acceleration along the surface [1/tau^2]
  T x_per_sigma;  // displacement along x for a displacement along the surface
  T x_per_rho;    // displacement along x for a distance from the surface
  double change;  // relative rate of change of P [1/tau]
  double fastest;  // that, or the rate at which the slope or the springs change [turns/tau]
};

// a = N P is the acceleration towards the surface of a tip that does not touch it, N^2 = 1 + s^2; lambda = a/N^2 is the
// reaction along y. The digit at the end of a name counts time derivatives; h1 to h4 are derivatives of h by x.
template <class T>
AFM_INLINED ReferenceForces<T> reference_forces(const Mechanics<T>& m, const T& eta, const SlideState<T>& q) {
  using std::sqrt;
  const SurfaceJet<T> h = surface_jet(m.H, q.phase);
  const T free = m.is_free_along_x, wh2 = m.omega_h * m.omega_h, wv2 = m.omega_v * m.omega_v;
  const T h1 = h.h1, h2 = h.h2, h3 = h.h3, h4 = -wv2 * h2;  // omega_v is the wave number of the surface
  const T u = q.u, u2 = u * u, X = q.X, X1 = u - eta;
  const T s = free * h1, s1 = free * h2 * u, N2 = 1.0 + s * s, per_N2 = 1.0 / N2, per_N = sqrt(per_N2);

  const T a = h2 * u2 - wh2 * h1 * X + wv2 * (h.h - m.y0), lambda = a * per_N2, x2 = -wh2 * X - s * lambda;
  const T a1 = u * (h3 * u2 + 2.0 * h2 * x2 + wv2 * h1) - wh2 * (h2 * u * X + h1 * X1);
  const T lambda1 = (a1 - 2.0 * s * s1 * lambda) * per_N2, x3 = -wh2 * X1 - s1 * lambda - s * lambda1;
  const T a2 = u2 * (h4 * u2 + 5.0 * h3 * x2) + 2.0 * h2 * (x2 * x2 + u * x3) + wv2 * (h2 * u2 + h1 * x2) -
               wh2 * ((h3 * u2 + h2 * x2) * X + 2.0 * h2 * u * X1 + h1 * x2);

  // (ln N)' = s turn, with turn = (arctan s)'
  const T turn = s1 * per_N2, turn1 = free * (h3 * u2 + h2 * x2) * per_N2 - 2.0 * s * turn * turn;
  const T L1 = s * turn, L2 = s1 * turn + s * turn1;
  ReferenceForces<T> f;
  f.P = a * per_N;
  f.P1 = a1 * per_N - f.P * L1;
  f.P2 = (a2 - 2.0 * a1 * L1) * per_N + f.P * (L1 * L1 - L2);
  f.turn = turn;
  f.K = 3.0 * turn * turn + (wh2 * s * s + wv2) * per_N2;

  // curvature, its derivative along the surface, the acceleration along the surface by the springs, the speed along it
  const T curvature = free * h2 * per_N2 * per_N;
  const T curvature1 = free * (h3 - 3.0 * s * h2 * h2 * per_N2) * per_N2 * per_N2;
  const T pull = (x2 + L1 * u) * N2 * per_N, speed2 = u2 * N2;
  f.c_height = s * (wh2 - wv2) * per_N2 - curvature * pull - curvature1 * speed2;
  f.c_sigma = (wh2 + wv2 * s * s) * per_N2 - curvature * (curvature * speed2 - f.P);
  f.x_per_sigma = free * per_N;
  f.x_per_rho = -s * per_N;

  // step control only, so derivatives by the start are not needed
  const double p1 = static_cast<double>(f.P1) / static_cast<double>(f.P);
  f.change = std::sqrt(std::max(p1 * p1, std::abs(static_cast<double>(f.P2) / static_cast<double>(f.P))));
  f.fastest = std::max({f.change, std::abs(static_cast<double>(u)), static_cast<double>(m.ratio), 1.0});
  return f;
}

}  // namespace afm
