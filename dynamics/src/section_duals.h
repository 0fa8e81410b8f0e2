// Between states of the section and dual numbers that carry the derivatives by them.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>

#include "core/contact/projection.h"
#include "dual.h"

namespace afm::detail {

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
