// The last digits of a periodic orbit: Newton's method with residuals in double-double.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "afm/dynamics/poincare_map.h"
#include "core/search/double_double.h"

namespace afm {

struct FinePoint {
  detail::DoubleDouble phase, X, u, g1;
};

struct FineStep {
  FinePoint after;
  detail::DoubleDouble dt, energy_loss;
};

struct FineOrbit {
  std::vector<FinePoint> points;
  std::vector<FineStep> steps;
};

// Precondition: `points` is an orbit to rounding, and `times` are the durations of its flights [tau]. `solve` returns
// the Newton step for the residuals of all flights.
FineOrbit polish(const PoincareMap& map, const std::vector<TipState>& points, const std::vector<double>& times,
                 const std::function<Eigen::VectorXd(const Eigen::VectorXd&)>& solve);

}  // namespace afm
