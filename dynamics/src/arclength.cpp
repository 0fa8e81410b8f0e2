#include "arclength.h"

namespace afm {
namespace {

// [a, a/tau] of an orbit on a branch: a choice, far above the rounding of a map
constexpr double kResidual = 1e-11;
constexpr double kParameterStep = 1e-6;  // of the difference quotient: about the cube root of the rounding
constexpr int kMaxCorrections = 12;      // Newton steps; they converge quadratically or not at all

}  // namespace

Eigen::VectorXd Arclength::difference(const Place& b, const Place& a) const {
  Eigen::VectorXd d(size(a) + 1);
  for (std::size_t i = 0; i < a.points.size(); ++i) {
    d.segment<4>(static_cast<Eigen::Index>(4 * i)) = weight_.cwiseProduct(section_difference(b.points[i], a.points[i]));
  }
  d[size(a)] = b.parameter - a.parameter;
  return d;
}

Place Arclength::displaced(const Place& a, const Eigen::VectorXd& d) const {
  Place b = a;
  for (std::size_t i = 0; i < a.points.size(); ++i) {
    const Eigen::Vector4d step = d.segment<4>(static_cast<Eigen::Index>(4 * i));
    b.points[i] = section_sum(a.points[i], step.cwiseQuotient(weight_));
  }
  b.parameter += d[size(a)];
  return b;
}

bool Arclength::residual(const Place& p, Eigen::VectorXd& error, std::vector<MapStep>* steps) const {
  if (!valid(p.parameter)) return false;
  const PoincareMap at = map(p.parameter);
  const std::size_t n = p.points.size();
  error.setZero(size(p) + 1);
  for (std::size_t i = 0; i < n; ++i) {
    const MapStep step = at(p.points[i]);
    if (step.outcome != MapOutcome::impact) return false;
    error.segment<4>(static_cast<Eigen::Index>(4 * i)) = section_difference(step.after, p.points[(i + 1) % n]);
    if (steps != nullptr) steps->push_back(step);
  }
  return true;
}

Model Arclength::model_at(double parameter) const {
  Model m = model_;
  if (vary_ == Parameter::gamma) m.gamma = parameter;
  if (vary_ == Parameter::cutoff) m.v_c = parameter;
  return m;
}

bool Arclength::valid(double parameter) const {
  return find_faults(model_at(parameter)).empty() &&
         (vary_ != Parameter::eta || (parameter != 0.0 && std::abs(parameter) <= kMaxEta));
}

Eigen::VectorXd Arclength::tangent(const Place& at, double target) const {
  const Eigen::VectorXd unit = Eigen::VectorXd::Unit(size(at) + 1, size(at));
  const Eigen::VectorXd ahead = target > at.parameter ? unit : Eigen::VectorXd(-unit);
  std::vector<MapStep> steps;
  Eigen::VectorXd error;
  Eigen::MatrixXd A;
  if (!residual(at, error, &steps) || !derivative(at, steps, ahead, A)) return ahead;
  const Eigen::VectorXd t = A.partialPivLu().solve(unit);
  return t.allFinite() ? Eigen::VectorXd(t.normalized()) : ahead;
}

bool Arclength::advance(const Place& from, const Eigen::VectorXd& direction, double step, Place& to) const {
  to = displaced(from, step * direction);
  for (int i = 0; i < kMaxCorrections; ++i) {
    std::vector<MapStep> steps;
    Eigen::VectorXd error;
    if (!residual(to, error, &steps)) return false;
    error[size(from)] = direction.dot(difference(to, from)) - step;
    if (error.lpNorm<Eigen::Infinity>() < kResidual) return same_branch(to, from, step);
    Eigen::MatrixXd A;
    if (!derivative(to, steps, direction, A)) return false;
    to = displaced(to, A.partialPivLu().solve(-error));
    if (!std::isfinite(to.parameter)) return false;
  }
  Eigen::VectorXd error;
  return residual(to, error, nullptr) && error.head(size(from)).lpNorm<Eigen::Infinity>() < kResidual &&
         same_branch(to, from, step);
}

bool Arclength::same_branch(const Place& to, const Place& from, double step) const {
  return difference(to, from).norm() < 2.0 * step + 1e-12;
}

bool Arclength::derivative(const Place& at, const std::vector<MapStep>& steps, const Eigen::VectorXd& direction,
                           Eigen::MatrixXd& A) const {
  const Eigen::Index n = static_cast<Eigen::Index>(at.points.size());
  A = Eigen::MatrixXd::Zero(4 * n + 1, 4 * n + 1);
  for (Eigen::Index i = 0; i < n; ++i) {
    A.block<4, 4>(4 * i, 4 * i) += steps[static_cast<std::size_t>(i)].J * weight_.cwiseInverse().asDiagonal();
    A.block<4, 4>(4 * i, 4 * ((i + 1) % n)) -= weight_.cwiseInverse().asDiagonal();
  }
  Place up = at, down = at;
  up.parameter += kParameterStep;
  down.parameter -= kParameterStep;
  Eigen::VectorXd high, low;
  const bool above = residual(up, high, nullptr), below = residual(down, low, nullptr);
  if (!above && !below) return false;
  Eigen::VectorXd here;
  if (!(above && below)) residual(at, here, nullptr);
  const Eigen::VectorXd slope =
      ((above ? high : here) - (below ? low : here)) / (above && below ? 2.0 * kParameterStep : kParameterStep);
  A.col(4 * n).head(4 * n) = slope.head(4 * n);
  A.row(4 * n) = direction.transpose();
  return true;
}

}  // namespace afm
