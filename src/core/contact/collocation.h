// One step of Lobatto's method of order 8. Its five points are the start of the step and four nodes, the last at its
// end. Hermite interpolation gives a function at the nodes from its value and three derivatives at both ends.
#pragma once

#include <cmath>
#include <cstddef>

namespace afm {

constexpr double kRoot21 = 4.58257569495584;
constexpr std::size_t kNodeCount = 4;
constexpr double kNodes[4] = {0.5 - kRoot21 / 14, 0.5, 0.5 + kRoot21 / 14, 1.0};
constexpr double kRest[4] = {1.0 - kNodes[0], 1.0 - kNodes[1], 1.0 - kNodes[2], 1.0 - kNodes[3]};

// kLobatto[k][i]: weight of the rate at point k in the integral from the start to node i.
constexpr double kLobatto[5][4] = {
    {(119 + 3 * kRoot21) / 1960, 13.0 / 320, (119 - 3 * kRoot21) / 1960, 1.0 / 20},
    {(343 - 9 * kRoot21) / 2520, (392 + 105 * kRoot21) / 2880, (343 + 69 * kRoot21) / 2520, 49.0 / 180},
    {(392 - 96 * kRoot21) / 2205, 8.0 / 45, (392 + 96 * kRoot21) / 2205, 16.0 / 45},
    {(343 - 69 * kRoot21) / 2520, (392 - 105 * kRoot21) / 2880, (343 + 9 * kRoot21) / 2520, 49.0 / 180},
    {(-21 + 3 * kRoot21) / 1960, 3.0 / 320, (-21 - 3 * kRoot21) / 1960, 1.0 / 20}};

// The polynomial of order 7: what the k-th derivative at the start adds at node i to the value and to its first two
// derivatives. The weights of the derivatives at the end follow by reflection, c -> 1 - c.
struct HermiteWeights {
  double value[4][4], slope[4][4], bend[4][4];
};

constexpr HermiteWeights hermite_weights(const double (&points)[4]) {
  HermiteWeights w{};
  for (std::size_t i = 0; i < 4; ++i) {
    const double c = points[i], r = 1 - c, r2 = r * r;
    const double Q[4] = {1 + c * (4 + c * (10 + c * 20)), c * (1 + c * (4 + c * 10)), c * c * (0.5 + c * 2),
                         c * c * c / 6};
    const double Q1[4] = {4 + c * (20 + c * 60), 1 + c * (8 + c * 30), c * (1 + c * 6), c * c / 2};
    const double Q2[4] = {20 + c * 120, 8 + c * 60, 1 + c * 12, c};
    for (std::size_t k = 0; k < 4; ++k) {
      w.value[k][i] = Q[k] * r2 * r2;
      w.slope[k][i] = (Q1[k] * r - 4 * Q[k]) * r2 * r;
      w.bend[k][i] = ((Q2[k] * r - 8 * Q1[k]) * r + 12 * Q[k]) * r2;
    }
  }
  return w;
}

constexpr HermiteWeights kFromStart = hermite_weights(kNodes), kFromEnd = hermite_weights(kRest);

// Value and three derivatives at one end of a step, each times a power of the step's length.
struct HermiteEnd {
  double scaled[4];
};
inline HermiteEnd hermite_end(double dt, double value, double first, double second, double third) {
  const double dt2 = dt * dt;
  return {{value, dt * first, dt2 * second, dt2 * dt * third}};
}

struct HermitePoint {
  double value, slope, bend;
};

// Value and first two derivatives at node i. `last` is taken with -dt: seen from the end, time runs backwards.
inline HermitePoint hermite(double dt, const HermiteEnd& first, const HermiteEnd& last, std::size_t i) {
  const double inverse_dt = 1.0 / dt;
  HermitePoint p{0.0, 0.0, 0.0};
#pragma GCC unroll 4
  for (std::size_t k = 0; k < 4; ++k) {
    const HermiteWeights &f = kFromStart, &g = kFromEnd;
    p.value = std::fma(f.value[k][i], first.scaled[k], std::fma(g.value[k][i], last.scaled[k], p.value));
    p.slope = std::fma(f.slope[k][i], first.scaled[k], std::fma(-g.slope[k][i], last.scaled[k], p.slope));
    p.bend = std::fma(f.bend[k][i], first.scaled[k], std::fma(g.bend[k][i], last.scaled[k], p.bend));
  }
  return {p.value, p.slope * inverse_dt, p.bend * inverse_dt * inverse_dt};
}

}  // namespace afm
