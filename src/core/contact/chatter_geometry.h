// The coefficients of the averaged law from the state of the reference slide (afm/detail/chatter_geometry.h). Inlined
// into the functions that are compiled for several machines.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "afm/detail/chatter_geometry.h"
#include "chatter_flow.h"

namespace afm {

template <class T>
inline T square(const T& x) {
  return x * x;
}

template <class T>
inline ChatterSurroundingsOf<T> ChatterGeometry::surroundings(const SlideSegment<T>& reference, const T& time) const {
  using std::sqrt;
  const T one(1.0), two(2.0), three(3.0), wh2(wh2_), wv2(wv2_), free(free_);
  const SlideState<T> q = reference.at(time);
  const std::array<T, 4> a = reference.pressure_jet(time);
  SurfaceJet<T> h = surface_jet(T(H_), q.phase);
  h.h1 *= free, h.h2 *= free, h.h3 *= free;
  const T u = q.u, u2 = u * u, N2 = one + square(h.h1), inverse_N2 = one / N2, inverse_N = sqrt(inverse_N2);
  // time derivatives: x2, x3 of x along the reference slide, s1 to s3 of the slope s
  const T s = h.h1, s1 = h.h2 * u, x2 = -wh2 * q.X - s * a[0];
  const T x3 = -wh2 * (u - reference.eta()) - s1 * a[0] - s * a[1], s2 = h.h3 * u2 + h.h2 * x2;
  const T s3 = u * (three * h.h3 * x2 - T(square(kTwoPi)) * h.h2 * u2) + h.h2 * x3;
  // turn rate of the surface (arctan s)' and its derivatives; L1 to L3: derivatives of ln N; p1 to p3: P'/P, P''/P,
  // P'''/P with P = N a
  const T turn = s1 * inverse_N2, turn1 = s2 * inverse_N2 - two * s * square(turn);
  const T turn2 = s3 * inverse_N2 - two * turn * (s * s2 * inverse_N2 + s1 * turn + two * s * turn1);
  const T L1 = s * turn, L2 = s1 * turn + s * turn1, L3 = s2 * turn + two * s1 * turn1 + s * turn2;
  const T inverse_a = one / a[0], q1 = a[1] * inverse_a, q2 = a[2] * inverse_a, q3 = a[3] * inverse_a;
  const T p1 = q1 + L1, b2 = q2 - square(q1) + L2, b3 = q3 - three * q1 * q2 + two * q1 * square(q1) + L3;
  const T p2 = b2 + square(p1), p3 = b3 + three * p1 * b2 + p1 * square(p1);
  ChatterSurroundingsOf<T> at{};
  at.P = a[0] * N2 * inverse_N;
  at.P1 = at.P * p1, at.P2 = at.P * p2, at.P3 = at.P * p3;
  at.K = three * square(turn) + (wh2 * square(s) + wv2) * inverse_N2;
  at.K1 = T(6.0) * turn * turn1 + two * L1 * (wh2 - wv2) * inverse_N2;
  set_reaction_terms(at);
  at.turn_rate = turn;
  // curvature h''/N^3, its derivative along the surface, the acceleration along the surface by the springs, the speed N
  // u
  const T curvature = h.h2 * inverse_N2 * inverse_N;
  const T curvature1 = (h.h3 - three * s * square(h.h2) * inverse_N2) * square(inverse_N2);
  const T pull = (x2 + L1 * u) * N2 * inverse_N, speed2 = u2 * N2;
  at.c_height = s * (wh2 - wv2) * inverse_N2 - curvature * pull - curvature1 * speed2;
  at.c_sigma = (wh2 + wv2 * square(s)) * inverse_N2 - curvature * (curvature * speed2 - at.P);
  at.x_per_sigma = free * inverse_N;
  at.x_per_rho = -s * inverse_N;
  // step control only, so derivatives by the start are not needed
  const double change = static_cast<double>(p1), bend = static_cast<double>(p2);
  at.relative_rate = std::sqrt(std::max(square(change), std::abs(bend)));
  at.slow_rate = std::max(std::abs(static_cast<double>(u)), slow_rate_);
  return at;
}

// As above with the state of the flight; the reaction comes from g2 and g3 of the gap.
inline ChatterSurroundings ChatterGeometry::surroundings(const Flight<double>& bounce) const {
  const TipState& q = bounce.launch();
  const GapJet<double>& start = bounce.start();
  const double k2 = square(kTwoPi), h1 = start.h1, h2 = -k2 * start.h;
  const double a = -start.g2, a1 = -start.g3, inverse_N2 = 1.0 / (1.0 + free_ * square(h1));
  ChatterSurroundings at{};
  at.P = a * std::sqrt(inverse_N2);
  at.inverse_P = 1.0 / at.P;
  at.c_speed = kThird * (a1 / a - free_ * h1 * h2 * q.u * inverse_N2);
  // second derivative of the reaction, with the change of u by the horizontal spring and by the reaction
  const double u = q.u, u2 = square(u), reaction = free_ * a * inverse_N2;
  const double x2 = -wh2_ * q.X - h1 * reaction, x3 = -wh2_ * (u - bounce.eta()) - h2 * u * reaction, x4 = -wh2_ * x2;
  const double a2 =
      h2 * (u2 * (wv2_ - k2 * u2) + 3.0 * square(x2) + 4.0 * u * x3) + h1 * ((wv2_ - 6.0 * k2 * u2) * x2 + x4);
  at.relative_rate = std::sqrt(std::max(9.0 * square(at.c_speed), std::abs(a2) / a));
  at.slow_rate = std::max(std::abs(q.u), slow_rate_);
  return at;
}

// A bounce lasts 2 v/P, and P is at most a; P'/P = a'/a - h' h'' u / N^2.
inline bool ChatterGeometry::certainly_outlasts(const Flight<double>& bounce, double part) const {
  const GapJet<double>& start = bounce.start();
  const double slope = free_ * start.h1, N2 = 1.0 + slope * start.h1, a = -start.g2;
  const double change = slope * square(kTwoPi) * start.h * bounce.launch().u * a - start.g3 * N2;
  return 2.0 * start.g1 * std::abs(change) > part * (a * a * N2);
}

}  // namespace afm
