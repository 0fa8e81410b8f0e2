#include "afm/dynamics/continuation.h"

#include <algorithm>
#include <cmath>
#include <complex>

#include "arclength.h"

namespace afm {
namespace {

// Steps along a branch, in arclength of parameter, a, and a/tau divided by 1 + |eta|. All are choices.
constexpr double kFirstStep = 1e-3, kLargestStep = 2e-2;
constexpr int kMostSteps = 2000;
constexpr double kEventTolerance = 1e-10;  // of the parameter at an event

// A branch ends at these limits. All are choices.
constexpr double kGrazingGap = 1e-5;    // [a] least gap of a flight on the way
constexpr double kGrazingSpeed = 1e-3;  // [a/tau] normal speed of an impact over 1 + |eta|
// [turns] distance of the horizontal spring's turns in a period from a whole number
constexpr double kResonantTurns = 5e-3;
constexpr double kResonantMultiplier = 0.02;  // distance of a multiplier from 1
constexpr double kSmallestStep = 1e-13;       // arclength; below it the step is rounding
constexpr int kMaxBisections = 60;            // down to the rounding of a step of 1

constexpr double kOnCircle = 1e-3;  // distance of a multiplier from where it passes, at an event found by bisection

double characteristic(const Multipliers& m, double root) {
  return std::real((m[0] - root) * (m[1] - root) * (m[2] - root) * (m[3] - root));
}

bool has_near(const Multipliers& m, double root) {
  return std::any_of(m.begin(), m.end(), [&](const auto& z) { return std::abs(z - root) < kOnCircle; });
}

// Argument of the pair on the unit circle [turns]; 0 without such a pair.
double turns_on_circle(const PeriodicOrbit& orbit) {
  for (const std::complex<double>& z : orbit.multipliers) {
    if (z.imag() > 0.0 && std::abs(std::abs(z) - 1.0) < kOnCircle) return std::arg(z) / kTwoPi;
  }
  return 0.0;
}

// An integer that changes at a bifurcation of the kind.
int bifurcation_sign(BifurcationKind kind, const PeriodicOrbit& orbit, double v_c) {
  const Multipliers& m = orbit.multipliers;
  switch (kind) {
    case BifurcationKind::corner:
      return static_cast<int>(
          std::count_if(orbit.speeds.begin(), orbit.speeds.end(), [&](double speed) { return speed < v_c; }));
    case BifurcationKind::saddle_node:
      return characteristic(m, 1.0) < 0.0 ? -1 : 1;
    case BifurcationKind::period_doubling:
      return characteristic(m, -1.0) < 0.0 ? -1 : 1;
    default:
      return static_cast<int>(
          std::count_if(m.begin(), m.end(), [](const auto& z) { return z.imag() != 0.0 && std::abs(z) > 1.0; }));
  }
}

int unstable_multipliers(const BranchPoint& at) {
  const Multipliers& m = at.orbit.multipliers;
  return static_cast<int>(std::count_if(m.begin(), m.end(), [](const auto& z) { return std::abs(z) > 1.0; }));
}

// Where an orbit is born in the period doubling of one half as long, its halves change places: the branch beyond is the
// same orbit, from its other half on.
bool swaps_halves(const Place& a, const Place& b) {
  const std::size_t n = a.points.size();
  if (n % 2 != 0) return false;
  const auto apart = [n](const Place& p) { return section_difference(p.points[n / 2], p.points[0]); };
  return apart(a).dot(apart(b)) < 0.0;
}

// True: the orbit at a change of sign is at a bifurcation of that kind. Multipliers may also jump past the unit circle
// at a corner, or a pair may split on the real axis.
bool confirms(BifurcationKind kind, const PeriodicOrbit& orbit) {
  switch (kind) {
    case BifurcationKind::saddle_node:
      return has_near(orbit.multipliers, 1.0);
    case BifurcationKind::period_doubling:
      return has_near(orbit.multipliers, -1.0);
    case BifurcationKind::torus:
      return turns_on_circle(orbit) > 0.0;
    default:
      return true;
  }
}

double value_of(const Model& model, double eta, Parameter parameter) {
  return parameter == Parameter::eta ? eta : parameter == Parameter::gamma ? model.gamma : model.v_c;
}

class Continuation {
 public:
  Continuation(const Model& model, double eta, Parameter vary, double target)
      : model_(model), eta_(eta), vary_(vary), target_(target), line_(model, eta, vary) {}

  Branch follow(const PeriodicOrbit& start) {
    Place before{start.points, value_of(model_, eta_, vary_)};
    branch_.points.push_back({before.parameter, start});
    Eigen::VectorXd direction = line_.tangent(before, target_);
    double step = kFirstStep;
    for (int i = 0; i < kMostSteps; ++i) {
      Place now;
      if (!line_.advance(before, direction, step, now)) {
        if (ends_at_target(before, direction, step)) return branch_;
        do {
          step *= 0.5;
          if (step < kSmallestStep) return end_at_loss();
        } while (!line_.advance(before, direction, step, now));
      }
      if (!take(before, direction, step, now)) return branch_;
      direction = line_.difference(now, before).normalized();
      before = now;
      step = std::min(1.5 * step, kLargestStep);
    }
    branch_.end = resonates(branch_.points.back()) ? BranchEnd::resonance : BranchEnd::steps_spent;
    return branch_;
  }

 private:
  // Without further Newton steps: at a fold they could lead to the other branch.
  BranchPoint describe(const Place& p) const { return {p.parameter, orbit_at(line_.map(p.parameter), p.points)}; }

  // Records the events between one point and the next. False at the end of the branch.
  bool take(const Place& before, const Eigen::VectorXd& direction, double step, const Place& now) {
    const BranchPoint from = branch_.points.back();
    BranchPoint to = describe(now);
    if (to.orbit.points.empty()) {
      branch_.end = BranchEnd::lost;
      return false;
    }
    if (swaps_halves(before, now)) {  // bisection would find the orbit half as long, which is next to it
      branch_.end = BranchEnd::period_doubling;
      return false;
    }
    const std::size_t known = branch_.events.size();
    for (const BifurcationKind kind : {BifurcationKind::corner, BifurcationKind::saddle_node,
                                       BifurcationKind::period_doubling, BifurcationKind::torus}) {
      const auto sign_of_kind = [&](const BranchPoint& at) { return sign(kind, at); };
      if (sign(kind, from) != sign(kind, to)) record(kind, change_of(sign_of_kind, before, direction, step));
    }
    // a pair that leaves the circle may be real before the next point
    const bool is_explained = branch_.events.size() > known || unstable_multipliers(from) == unstable_multipliers(to);
    if (!is_explained) record(BifurcationKind::torus, change_of(unstable_multipliers, before, direction, step));
    if ((to.parameter - target_) * (branch_.points.front().parameter - target_) <= 0.0) {
      branch_.end = BranchEnd::target;
      const double share = (target_ - from.parameter) / (to.parameter - from.parameter);
      const OrbitResult last =
          find_orbit(line_.map(target_), line_.displaced(before, share * line_.difference(now, before)).points);
      if (last.outcome == OrbitOutcome::found) to = {target_, last.orbit};
      branch_.points.push_back(to);
      return false;
    }
    branch_.points.push_back(to);
    return true;
  }

  // Where a step that leads past the target fails, as there may be no orbit, or no such parameter, behind it.
  bool ends_at_target(const Place& before, const Eigen::VectorXd& direction, double step) {
    const double share = (target_ - before.parameter) / direction[direction.size() - 1];
    if (!(share > 0.0 && share <= step)) return false;
    const OrbitResult last = find_orbit(line_.map(target_), line_.displaced(before, share * direction).points);
    if (last.outcome != OrbitOutcome::found) return false;
    const Place at{last.orbit.points, target_};
    return line_.same_branch(at, before, share) && !take(before, direction, share, at);
  }

  int sign(BifurcationKind kind, const BranchPoint& at) const {
    return bifurcation_sign(kind, at.orbit, vary_ == Parameter::cutoff ? at.parameter : model_.v_c);
  }

  // The orbit where the integer changes, by bisection of the step.
  template <class Sign>
  BranchPoint change_of(const Sign& sign, const Place& before, const Eigen::VectorXd& direction, double step) const {
    double low = 0.0, high = step;
    BranchPoint at = branch_.points.back();
    const int first = sign(at);
    for (int i = 0; i < kMaxBisections && high - low > kEventTolerance * 0.1; ++i) {
      const double middle = 0.5 * (low + high);
      Place there;
      if (!line_.advance(before, direction, middle, there)) break;
      const BranchPoint point = describe(there);
      if (point.orbit.points.empty()) break;
      if (sign(point) == first) {
        low = middle;
        at = point;
      } else {
        high = middle;
      }
    }
    return at;
  }

  void record(BifurcationKind kind, const BranchPoint& at) {
    if (!confirms(kind, at.orbit)) return;
    branch_.events.push_back({kind, at, kind == BifurcationKind::torus ? turns_on_circle(at.orbit) : 0.0});
  }

  Branch end_at_loss() {
    const BranchPoint& last = branch_.points.back();
    const double eta = vary_ == Parameter::eta ? last.parameter : eta_;
    branch_.end = resonates(last) ? BranchEnd::resonance : BranchEnd::lost;
    if (last.orbit.clearance < kGrazingGap || last.orbit.slowest_impact < kGrazingSpeed * (1.0 + std::abs(eta))) {
      branch_.end = BranchEnd::grazing;
      branch_.events.push_back({BifurcationKind::grazing, last, 0.0});
    }
    return branch_;
  }

  bool resonates(const BranchPoint& at) const {
    if (model_.kind == ModelKind::hammer) return false;
    const double turns = at.orbit.period * model_.frequency_ratio;
    return std::abs(turns - std::round(turns)) < kResonantTurns &&
           std::abs(at.orbit.multipliers[1] - 1.0) < kResonantMultiplier;
  }

  const Model model_;
  const double eta_;
  const Parameter vary_;
  const double target_;
  const Arclength line_;
  Branch branch_;
};

}  // namespace

const char* name(BifurcationKind kind) {
  constexpr const char* kNames[] = {"saddle-node", "period doubling", "torus", "corner", "grazing"};
  return kNames[static_cast<std::size_t>(kind)];  // in the order of BifurcationKind
}

Branch continue_orbit(const Model& model, double eta, const PeriodicOrbit& start, Parameter vary, double target) {
  return Continuation(model, eta, vary, target).follow(start);
}

}  // namespace afm
