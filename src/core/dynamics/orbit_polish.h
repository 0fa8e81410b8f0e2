// The last digits of a periodic orbit: Newton's method with errors computed in double-double.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "afm/detail/double_double.h"
#include "afm/dynamics/poincare_map.h"

namespace afm {

struct FinePoint {
  DoubleDouble phase, X, u, g1;
};

struct FineStep {
  FinePoint after;
  DoubleDouble dt, energy_loss;
};

// From an impact to the next, near the time `guess` [tau].
FineStep fine_map(const Model& model, double eta, const FinePoint& start, double guess);

struct FineOrbit {
  std::vector<FinePoint> points;
  std::vector<FineStep> steps;
};

// From an orbit good to rounding, the times of its flights, and what solves for Newton's step given the errors of all
// flights.
FineOrbit polish(const PoincareMap& map, const std::vector<TipState>& points, const std::vector<double>& times,
                 const std::function<Eigen::VectorXd(const Eigen::VectorXd&)>& solve);

}  // namespace afm
