// One step of an integrator through Lobatto's five points, of order 8, and Hermite's interpolation to its inner ones of
// a function of which the value and three derivatives are known at both ends.
#pragma once

#include <array>
#include <cmath>

#include "afm_emulator/multiversion.h"

namespace afm {

constexpr double kRoot21 = 4.58257569495584;
constexpr std::array<double, 4> kNodes = {0.5 - kRoot21 / 14, 0.5, 0.5 + kRoot21 / 14, 1.0};  // without the first

// From the beginning to each inner node and to the end: the weights of the rates at all five.
constexpr std::array<std::array<double, 5>, 4> kLobatto = {{
    {(119 + 3 * kRoot21) / 1960, (343 - 9 * kRoot21) / 2520, (392 - 96 * kRoot21) / 2205, (343 - 69 * kRoot21) / 2520,
     (-21 + 3 * kRoot21) / 1960},
    {13.0 / 320, (392 + 105 * kRoot21) / 2880, 8.0 / 45, (392 - 105 * kRoot21) / 2880, 3.0 / 320},
    {(119 - 3 * kRoot21) / 1960, (343 + 69 * kRoot21) / 2520, (392 + 96 * kRoot21) / 2205, (343 + 9 * kRoot21) / 2520,
     (-21 - 3 * kRoot21) / 1960},
    {1.0 / 20, 49.0 / 180, 16.0 / 45, 49.0 / 180, 1.0 / 20},
}};

// Of the polynomial of order 7, at a part c of the step: what each derivative at the beginning adds to the value and to
// its first two derivatives. What those at the end add follows by reflection.
struct HermiteWeights {
  std::array<double, 4> value, slope, bend;
};

constexpr HermiteWeights hermite_weights(double c) {
  const double Q[4] = {1 + c * (4 + c * (10 + c * 20)), c * (1 + c * (4 + c * 10)), c * c * (0.5 + c * 2),
                       c * c * c / 6};
  const double Q1[4] = {4 + c * (20 + c * 60), 1 + c * (8 + c * 30), c * (1 + c * 6), c * c / 2};
  const double Q2[4] = {20 + c * 120, 8 + c * 60, 1 + c * 12, c};
  const double r = 1 - c, r2 = r * r;
  HermiteWeights w{};
  for (std::size_t k = 0; k < 4; ++k) {
    w.value[k] = Q[k] * r2 * r2;
    w.slope[k] = (Q1[k] * r - 4 * Q[k]) * r2 * r;
    w.bend[k] = ((Q2[k] * r - 8 * Q1[k]) * r + 12 * Q[k]) * r2;
  }
  return w;
}

constexpr std::array<HermiteWeights, 3> kHermite = {hermite_weights(kNodes[0]), hermite_weights(kNodes[1]),
                                                    hermite_weights(kNodes[2])};

// The value and two derivatives at an inner node, from those at both ends.
AFM_INLINED std::array<double, 3> hermite(std::size_t node, double dt, const std::array<double, 4>& first,
                                          const std::array<double, 4>& last) {
  const double dt2 = dt * dt, dt3 = dt2 * dt, per_dt = 1.0 / dt;
  const double a[4] = {first[0], dt * first[1], dt2 * first[2], dt3 * first[3]};
  const double b[4] = {last[0], -dt * last[1], dt2 * last[2], -dt3 * last[3]};
  const HermiteWeights &f = kHermite[node], &g = kHermite[2 - node];
  double value = 0.0, slope = 0.0, bend = 0.0;
#pragma GCC unroll 4
  for (std::size_t k = 0; k < 4; ++k) {
    value = std::fma(f.value[k], a[k], std::fma(g.value[k], b[k], value));
    slope = std::fma(f.slope[k], a[k], std::fma(-g.slope[k], b[k], slope));
    bend = std::fma(f.bend[k], a[k], std::fma(g.bend[k], b[k], bend));
  }
  return {value, slope * per_dt, bend * per_dt * per_dt};
}

}  // namespace afm
