// Steps along a branch of periodic orbits by pseudo-arclength: all points of an orbit and the varied parameter
// together.
#pragma once

#include <Eigen/LU>
#include <cmath>
#include <vector>

#include "afm/dynamics/continuation.h"

namespace afm {

struct Place {
  std::vector<TipState> points;
  double parameter;
};

class Arclength {
 public:
  Arclength(const Model& model, double eta, Parameter vary)
      : model_(model),
        eta_(eta),
        vary_(vary),
        weight_(1.0, 1.0, 1.0 / (1.0 + std::abs(eta)), 1.0 / (1.0 + std::abs(eta))) {}

  // At a value of the varied parameter.
  PoincareMap map(double parameter) const {
    return PoincareMap(model_at(parameter), vary_ == Parameter::eta ? parameter : eta_);
  }

  // As one vector, with velocities divided by 1 + |eta|.
  Eigen::VectorXd difference(const Place& b, const Place& a) const;
  Place displaced(const Place& a, const Eigen::VectorXd& d) const;

  // The direction of the branch towards the target.
  Eigen::VectorXd tangent(const Place& at, double target) const;

  // Newton's method for the orbit at the distance `step` from `from` along `direction`. False if it does not converge.
  bool advance(const Place& from, const Eigen::VectorXd& direction, double step, Place& to) const;

  // False if Newton's method has converged to another orbit.
  bool same_branch(const Place& to, const Place& from, double step) const;

 private:
  static Eigen::Index size(const Place& p) { return static_cast<Eigen::Index>(4 * p.points.size()); }
  bool residual(const Place& p, Eigen::VectorXd& error, std::vector<MapStep>* steps) const;
  Model model_at(double parameter) const;
  bool valid(double parameter) const;
  bool derivative(const Place& at, const std::vector<MapStep>& steps, const Eigen::VectorXd& direction,
                  Eigen::MatrixXd& A) const;

  const Model model_;
  const double eta_;
  const Parameter vary_;
  const Eigen::Vector4d weight_;
};

}  // namespace afm
