// One step of an integrator through Lobatto's five points, of order 8, and Hermite's interpolation to them of a
// function of which the value and three derivatives are known at both ends. At four points at once: all but the first.
#pragma once

#include <cmath>
#include <cstddef>

#include "afm/detail/multiversion.h"
#include "afm/detail/select.h"

namespace afm {

constexpr double kRoot21 = 4.58257569495584;
constexpr double kNodes[4] = {0.5 - kRoot21 / 14, 0.5, 0.5 + kRoot21 / 14, 1.0};
constexpr double kRest[4] = {1.0 - kNodes[0], 1.0 - kNodes[1], 1.0 - kNodes[2], 1.0 - kNodes[3]};

// From the beginning to each: the weights of the rates at all five.
constexpr double kLobatto[5][4] = {
    {(119 + 3 * kRoot21) / 1960, 13.0 / 320, (119 - 3 * kRoot21) / 1960, 1.0 / 20},
    {(343 - 9 * kRoot21) / 2520, (392 + 105 * kRoot21) / 2880, (343 + 69 * kRoot21) / 2520, 49.0 / 180},
    {(392 - 96 * kRoot21) / 2205, 8.0 / 45, (392 + 96 * kRoot21) / 2205, 16.0 / 45},
    {(343 - 69 * kRoot21) / 2520, (392 - 105 * kRoot21) / 2880, (343 + 9 * kRoot21) / 2520, 49.0 / 180},
    {(-21 + 3 * kRoot21) / 1960, 3.0 / 320, (-21 - 3 * kRoot21) / 1960, 1.0 / 20}};

// Of the polynomial of order 7: what each derivative at the beginning adds at each point to the value and to its first
// two derivatives. What those at the end add follows by reflection, c -> 1 - c.
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

constexpr HermiteWeights kFromBeginning = hermite_weights(kNodes), kFromEnd = hermite_weights(kRest);

// Four numbers, one for each point.
template <class T>
T at_every_node(const double (&x)[4]);

template <class T>
struct HermiteOf {
  T value, slope, bend;
};

// The value and two derivatives at each point, from the value and three derivatives at both ends.
template <class T>
AFM_INLINED HermiteOf<T> hermite(double dt, const double (&first)[4], const double (&last)[4]) {
  const double dt2 = dt * dt, dt3 = dt2 * dt, inverse_dt = 1.0 / dt;
  const double a[4] = {first[0], dt * first[1], dt2 * first[2], dt3 * first[3]};
  const double b[4] = {last[0], -dt * last[1], dt2 * last[2], -dt3 * last[3]};
  T value(0.0), slope(0.0), bend(0.0);
#pragma GCC unroll 4
  for (std::size_t k = 0; k < 4; ++k) {
    const HermiteWeights &f = kFromBeginning, &g = kFromEnd;
    const T from_first(a[k]), from_last(b[k]);
    value = mul_add(at_every_node<T>(f.value[k]), from_first, mul_add(at_every_node<T>(g.value[k]), from_last, value));
    slope =
        mul_add(at_every_node<T>(f.slope[k]), from_first, mul_add(T(-at_every_node<T>(g.slope[k])), from_last, slope));
    bend = mul_add(at_every_node<T>(f.bend[k]), from_first, mul_add(at_every_node<T>(g.bend[k]), from_last, bend));
  }
  return {value, slope * T(inverse_dt), bend * T(inverse_dt) * T(inverse_dt)};
}

}  // namespace afm
