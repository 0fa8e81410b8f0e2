// Dual numbers: values with their derivatives by N variables. The templates of the core, run with them, give exact
// Jacobians. They are our own because Eigen's AutoDiffScalar takes more than twice as long for the same bits
// (docs/history.md).
#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <cstddef>

#include "afm/detail/turns.h"
#include "core/contact/projection.h"

namespace afm::detail {

template <std::size_t N>
struct Dual {
  double value = 0.0;
  std::array<double, N> by{};  // derivatives

  Dual() = default;
  Dual(double v) : value(v) {}  // a constant; implicit, as numbers are
  explicit operator double() const { return value; }

  static Dual variable(double v, std::size_t i) {
    Dual x(v);
    x.by[i] = 1.0;
    return x;
  }

  // friends, so that either side may be a number
  friend Dual operator-(const Dual& a) { return chain(-a.value, -1.0, a); }
  friend Dual operator+(const Dual& a, const Dual& b) { return chain(a.value + b.value, 1.0, a, 1.0, b); }
  friend Dual operator-(const Dual& a, const Dual& b) { return chain(a.value - b.value, 1.0, a, -1.0, b); }
  friend Dual operator*(const Dual& a, const Dual& b) { return chain(a.value * b.value, b.value, a, a.value, b); }
  friend Dual operator/(const Dual& a, const Dual& b) {
    const double q = a.value / b.value;
    return chain(q, 1.0 / b.value, a, -q / b.value, b);
  }
  friend Dual& operator*=(Dual& a, const Dual& b) { return a = a * b; }
  friend bool operator<(const Dual& a, const Dual& b) { return a.value < b.value; }
};

// f(a), given its value and derivative; f(a, b) likewise.
template <std::size_t N>
Dual<N> chain(double value, double slope, const Dual<N>& a) {
  Dual<N> f(value);
  for (std::size_t i = 0; i < N; ++i) f.by[i] = slope * a.by[i];
  return f;
}
template <std::size_t N>
Dual<N> chain(double value, double by_a, const Dual<N>& a, double by_b, const Dual<N>& b) {
  Dual<N> f(value);
  for (std::size_t i = 0; i < N; ++i) f.by[i] = by_a * a.by[i] + by_b * b.by[i];
  return f;
}

template <std::size_t N>
Dual<N> fma(const Dual<N>& a, const Dual<N>& b, const Dual<N>& c) {
  return a * b + c;
}
template <std::size_t N>
Dual<N> sqrt(const Dual<N>& a) {
  const double root = std::sqrt(a.value);
  return chain(root, 0.5 / root, a);
}
template <std::size_t N>
SinCos<Dual<N>> sin_cos_turns(const Dual<N>& a) {
  const SinCos<double> turn = sin_cos_turns(a.value);
  return {chain(turn.sin, two_pi<double>() * turn.cos, a), chain(turn.cos, -two_pi<double>() * turn.sin, a)};
}

using Dual3 = Dual<3>;
using Dual4 = Dual<4>;
template <>
inline Dual3 two_pi<Dual3>() {
  return two_pi<double>();
}
template <>
inline Dual4 two_pi<Dual4>() {
  return two_pi<double>();
}

// The state after a bounce as four independent variables.
inline BounceState<Dual4> section_variables(const TipState& s) {
  return {Dual4::variable(s.phase, 0), Dual4::variable(s.X, 1), Dual4::variable(s.u, 2), Dual4::variable(s.g1, 3)};
}

template <std::size_t N>
using SquareMatrix = Eigen::Matrix<double, static_cast<int>(N), static_cast<int>(N)>;

// The matrix of all derivatives: a row for each value, a column for each variable.
template <std::size_t N>
SquareMatrix<N> derivatives(const std::array<Dual<N>, N>& values) {
  SquareMatrix<N> J;
  for (std::size_t i = 0; i < N; ++i) {
    for (std::size_t k = 0; k < N; ++k) J(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(k)) = values[i].by[k];
  }
  return J;
}

}  // namespace afm::detail
