#include "afm_emulator/continuation.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace afm {
namespace {

using Points = std::vector<TipState>;

constexpr double kTouch = 1e-9;    // a gap this small on the way is a graze [a]
constexpr double kNoSpeed = 1e-3;  // an impact this slow, against the drag, is one
constexpr double kSmallestStep = 1e-13;
constexpr double kNear = 1e-11;  // of an orbit, while the branch is followed [a, a/tau]; its points are refined after

// All points and the parameter as one vector, in which velocities count less.
struct Place {
  Points points;
  double parameter;
};

class Continuation {
 public:
  Continuation(const Model& model, double eta, Parameter vary, double target, const ContinuationSettings& settings)
      : model_(model),
        eta_(eta),
        vary_(vary),
        target_(target),
        settings_(settings),
        weight_(1.0, 1.0, 1.0 / (1.0 + std::abs(eta)), 1.0 / (1.0 + std::abs(eta))) {}

  Branch follow(const PeriodicOrbit& start) {
    Place before{start.points, value_of(model_, eta_, vary_)};
    branch_.points.push_back({before.parameter, start});
    Eigen::VectorXd direction = tangent(before);
    double step = settings_.first_step;
    for (int i = 0; i < settings_.most_steps; ++i) {
      Place now;
      while (!advance(before, direction, step, now)) {
        step *= 0.5;
        if (step < kSmallestStep) return end_at_loss();
      }
      if (!take(before, direction, step, now)) return branch_;
      direction = difference(now, before).normalized();
      before = now;
      step = std::min(1.5 * step, settings_.largest_step);
    }
    branch_.end = resonates(branch_.points.back()) ? BranchEnd::resonance : BranchEnd::steps_spent;
    return branch_;
  }

 private:
  static Eigen::Index size(const Place& p) { return static_cast<Eigen::Index>(4 * p.points.size()); }
  PoincareMap map(double parameter) const { return map_at(model_, eta_, vary_, parameter); }

  Eigen::VectorXd difference(const Place& b, const Place& a) const {
    Eigen::VectorXd d(size(a) + 1);
    for (std::size_t i = 0; i < a.points.size(); ++i) {
      d.segment<4>(static_cast<Eigen::Index>(4 * i)) =
          weight_.cwiseProduct(section_difference(b.points[i], a.points[i]));
    }
    d[size(a)] = b.parameter - a.parameter;
    return d;
  }
  Place moved(const Place& a, const Eigen::VectorXd& d) const {
    Place b = a;
    for (std::size_t i = 0; i < a.points.size(); ++i) {
      const Eigen::Vector4d step = d.segment<4>(static_cast<Eigen::Index>(4 * i));
      b.points[i] = section_sum(a.points[i], step.cwiseQuotient(weight_));
    }
    b.parameter += d[size(a)];
    return b;
  }

  bool residual(const Place& p, Eigen::VectorXd& error, std::vector<MapStep>* steps) const {
    if (!valid(p.parameter)) return false;
    const PoincareMap at = map(p.parameter);
    const std::size_t n = p.points.size();
    error.resize(size(p) + 1);
    for (std::size_t i = 0; i < n; ++i) {
      const MapStep step = at(p.points[i]);
      if (step.outcome != MapOutcome::impact) return false;
      error.segment<4>(static_cast<Eigen::Index>(4 * i)) = section_difference(step.after, p.points[(i + 1) % n]);
      if (steps != nullptr) steps->push_back(step);
    }
    return true;
  }
  bool valid(double parameter) const {
    Model m = model_;
    if (vary_ == Parameter::gamma) m.gamma = parameter;
    if (vary_ == Parameter::cutoff) m.v_c = parameter;
    return find_faults(m).empty() && (vary_ != Parameter::eta || (parameter != 0.0 && std::abs(parameter) <= kMaxEta));
  }

  // Along the branch, the parameter towards its target.
  Eigen::VectorXd tangent(const Place& at) const {
    const Eigen::VectorXd unit = Eigen::VectorXd::Unit(size(at) + 1, size(at));
    const Eigen::VectorXd ahead = target_ > at.parameter ? unit : Eigen::VectorXd(-unit);
    std::vector<MapStep> steps;
    Eigen::VectorXd error;
    Eigen::MatrixXd A;
    if (!residual(at, error, &steps) || !derivative(at, steps, ahead, A)) return ahead;
    const Eigen::VectorXd t = A.partialPivLu().solve(unit);
    return t.allFinite() ? Eigen::VectorXd(t.normalized()) : ahead;
  }

  // Newton's method for the orbit at the distance `step` from `from` along `direction`.
  bool advance(const Place& from, const Eigen::VectorXd& direction, double step, Place& to) const {
    to = moved(from, step * direction);
    constexpr int kMostSteps = 12;
    for (int i = 0; i < kMostSteps; ++i) {
      std::vector<MapStep> steps;
      Eigen::VectorXd error;
      if (!residual(to, error, &steps)) return false;
      error[size(from)] = direction.dot(difference(to, from)) - step;
      if (error.lpNorm<Eigen::Infinity>() < kNear) return same_branch(to, from, step);
      Eigen::MatrixXd A;
      if (!derivative(to, steps, direction, A)) return false;
      to = moved(to, A.partialPivLu().solve(-error));
      if (!std::isfinite(to.parameter)) return false;
    }
    Eigen::VectorXd error;
    return residual(to, error, nullptr) && error.head(size(from)).lpNorm<Eigen::Infinity>() < kNear &&
           same_branch(to, from, step);
  }

  // Newton's steps must not land on another orbit.
  bool same_branch(const Place& to, const Place& from, double step) const {
    return difference(to, from).norm() < 2.0 * step + 1e-12;
  }

  bool derivative(const Place& at, const std::vector<MapStep>& steps, const Eigen::VectorXd& direction,
                  Eigen::MatrixXd& A) const {
    const Eigen::Index n = static_cast<Eigen::Index>(at.points.size());
    A = Eigen::MatrixXd::Zero(4 * n + 1, 4 * n + 1);
    for (Eigen::Index i = 0; i < n; ++i) {
      A.block<4, 4>(4 * i, 4 * i) += steps[static_cast<std::size_t>(i)].J * weight_.cwiseInverse().asDiagonal();
      A.block<4, 4>(4 * i, 4 * ((i + 1) % n)) -= weight_.cwiseInverse().asDiagonal();
    }
    const double kStep = 1e-6;
    Place up = at, down = at;
    up.parameter += kStep;
    down.parameter -= kStep;
    Eigen::VectorXd high, low;
    const bool above = residual(up, high, nullptr), below = residual(down, low, nullptr);
    if (!above && !below) return false;
    Eigen::VectorXd here;
    if (!(above && below)) residual(at, here, nullptr);
    const Eigen::VectorXd slope =
        ((above ? high : here) - (below ? low : here)) / (above && below ? 2.0 * kStep : kStep);
    A.col(4 * n).head(4 * n) = slope.head(4 * n);
    A.row(4 * n) = direction.transpose();
    return true;
  }

  // Without Newton's steps once more: at a fold they would lead to the other branch.
  BranchPoint describe(const Place& p) const { return {p.parameter, orbit_at(map(p.parameter), p.points)}; }

  // What has happened between one point and the next; false where the branch is at its end.
  bool take(const Place& before, const Eigen::VectorXd& direction, double step, const Place& now) {
    const BranchPoint from = branch_.points.back();
    BranchPoint to = describe(now);
    if (to.orbit.points.empty()) {
      branch_.end = BranchEnd::lost;
      return false;
    }
    for (const BifurcationKind kind : {BifurcationKind::corner, BifurcationKind::saddle_node,
                                       BifurcationKind::period_doubling, BifurcationKind::torus}) {
      if (sign(kind, from) != sign(kind, to)) locate(kind, before, direction, step);
    }
    if ((to.parameter - target_) * (branch_.points.front().parameter - target_) <= 0.0) {
      branch_.end = BranchEnd::target;
      const double share = (target_ - from.parameter) / (to.parameter - from.parameter);
      const OrbitResult last = find_orbit(map(target_), moved(before, share * difference(now, before)).points);
      if (last.outcome == OrbitOutcome::found) to = {target_, last.orbit};
      branch_.points.push_back(to);
      return false;
    }
    branch_.points.push_back(to);
    return true;
  }

  // Changes where a bifurcation of the kind is.
  int sign(BifurcationKind kind, const BranchPoint& at) const {
    const Multipliers& m = at.orbit.multipliers;
    const double v_c = vary_ == Parameter::cutoff ? at.parameter : model_.v_c;
    switch (kind) {
      case BifurcationKind::corner:
        return at.orbit.slowest_impact < v_c ? -1 : 1;
      case BifurcationKind::saddle_node:
      case BifurcationKind::period_doubling: {
        const double root = kind == BifurcationKind::saddle_node ? 1.0 : -1.0;
        const std::complex<double> p = (m[0] - root) * (m[1] - root) * (m[2] - root) * (m[3] - root);
        return p.real() < 0.0 ? -1 : 1;
      }
      default: {
        int outside = 0;
        for (const auto& z : m) outside += z.imag() != 0.0 && std::abs(z) > 1.0 ? 1 : 0;
        bool real_outside = false;  // a pair that meets on the real axis outside is no torus
        for (const auto& z : m) real_outside = real_outside || (z.imag() == 0.0 && std::abs(z) > 1.0);
        return real_outside ? 2 : outside;
      }
    }
  }

  // By halves of the step.
  void locate(BifurcationKind kind, const Place& before, const Eigen::VectorXd& direction, double step) {
    double low = 0.0, high = step;
    const int first = sign(kind, branch_.points.back());
    BranchPoint at = branch_.points.back(), beyond;
    for (int i = 0; i < 60 && high - low > settings_.event_tolerance * 0.1; ++i) {
      const double middle = 0.5 * (low + high);
      Place there;
      if (!advance(before, direction, middle, there)) break;
      const BranchPoint point = describe(there);
      if (point.orbit.points.empty()) break;
      if (sign(kind, point) == first) {
        low = middle;
        at = point;
      } else {
        high = middle;
        beyond = point;
      }
    }
    add_event(kind, at);
  }

  void add_event(BifurcationKind kind, const BranchPoint& at) {
    BranchEvent event{kind, at, 0.0};
    constexpr double kOnCircle = 1e-3;
    const auto on_circle = [&](const std::complex<double>& target) {
      return std::any_of(at.orbit.multipliers.begin(), at.orbit.multipliers.end(),
                         [&](const auto& z) { return std::abs(z - target) < kOnCircle; });
    };
    // where the sign has changed by a jump of the multipliers it is the corner's doing
    if (kind == BifurcationKind::saddle_node && !on_circle(1.0)) return;
    if (kind == BifurcationKind::period_doubling && !on_circle(-1.0)) return;
    if (kind == BifurcationKind::torus) {
      const auto pair = std::find_if(at.orbit.multipliers.begin(), at.orbit.multipliers.end(), [&](const auto& z) {
        return z.imag() > 0.0 && std::abs(std::abs(z) - 1.0) < kOnCircle;
      });
      if (pair == at.orbit.multipliers.end()) return;
      event.turns = std::arg(*pair) / kTwoPi;
    }
    branch_.events.push_back(event);
  }

  Branch end_at_loss() {
    const BranchPoint& last = branch_.points.back();
    branch_.end = resonates(last) ? BranchEnd::resonance : BranchEnd::lost;
    if (last.orbit.clearance < 1e4 * kTouch || last.orbit.slowest_impact < kNoSpeed * (1.0 + std::abs(eta_))) {
      branch_.end = BranchEnd::grazing;
      branch_.events.push_back({BifurcationKind::grazing, last, 0.0});
    }
    return branch_;
  }

  bool resonates(const BranchPoint& at) const {
    const double turns = at.orbit.period * model_.frequency_ratio;
    return std::abs(turns - std::round(turns)) < 5e-3 && std::abs(at.orbit.multipliers[1] - 1.0) < 0.02;
  }

  const Model model_;
  const double eta_;
  const Parameter vary_;
  const double target_;
  const ContinuationSettings settings_;
  const Eigen::Vector4d weight_;
  Branch branch_;
};

}  // namespace

const char* name(BifurcationKind kind) {
  switch (kind) {
    case BifurcationKind::saddle_node:
      return "saddle-node";
    case BifurcationKind::period_doubling:
      return "period doubling";
    case BifurcationKind::torus:
      return "torus";
    case BifurcationKind::corner:
      return "corner";
    default:
      return "grazing";
  }
}

PoincareMap map_at(const Model& model, double eta, Parameter vary, double value) {
  Model m = model;
  if (vary == Parameter::gamma) m.gamma = value;
  if (vary == Parameter::cutoff) m.v_c = value;
  return PoincareMap(m, vary == Parameter::eta ? value : eta);
}

double value_of(const Model& model, double eta, Parameter parameter) {
  return parameter == Parameter::eta ? eta : parameter == Parameter::gamma ? model.gamma : model.v_c;
}

Branch continue_orbit(const Model& model, double eta, const PeriodicOrbit& start, Parameter vary, double target,
                      const ContinuationSettings& settings) {
  return Continuation(model, eta, vary, target, settings).follow(start);
}

}  // namespace afm
