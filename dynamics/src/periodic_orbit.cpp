#include "afm/dynamics/periodic_orbit.h"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <limits>

#include "afm/detail/flight_jets.h"
#include "afm/dynamics/jacobian.h"
#include "core/search/double_double.h"

namespace afm {

using namespace detail;

namespace {

// Newton's method. All are choices.
constexpr double kFoundResidual = 1e-13;  // [a, a/tau]
constexpr int kMostNewtonSteps = 60;
constexpr double kSmallestShare = 1e-3;  // of a step

using Points = std::vector<TipState>;

// The map at every point, and the distance of each image from the next point.
struct Shot {
  bool landed = true;
  std::vector<MapStep> steps;
  Eigen::VectorXd error;

  double residual() const { return landed ? error.lpNorm<Eigen::Infinity>() : std::numeric_limits<double>::infinity(); }
};

Shot shoot(const PoincareMap& map, const Points& points) {
  const std::size_t n = points.size();
  Shot shot;
  shot.error.resize(static_cast<Eigen::Index>(4 * n));
  for (std::size_t i = 0; i < n; ++i) {
    shot.steps.push_back(map(points[i]));
    if (shot.steps.back().outcome != MapOutcome::impact) {
      shot.landed = false;
      return shot;
    }
    shot.error.segment<4>(static_cast<Eigen::Index>(4 * i)) =
        section_difference(shot.steps.back().after, points[(i + 1) % n]);
  }
  return shot;
}

// J_i d_i - d_(i+1) = -error_i around the orbit.
Eigen::VectorXd newton_step(const Shot& shot, const Eigen::VectorXd& error) {
  const Eigen::Index n = static_cast<Eigen::Index>(shot.steps.size());
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(4 * n, 4 * n);
  for (Eigen::Index i = 0; i < n; ++i) {
    A.block<4, 4>(4 * i, 4 * i) += shot.steps[static_cast<std::size_t>(i)].J;
    A.block<4, 4>(4 * i, 4 * ((i + 1) % n)) -= Eigen::Matrix4d::Identity();
  }
  return A.partialPivLu().solve(-error);
}

Points displaced(const Points& points, const Eigen::VectorXd& step, double share) {
  Points result;
  for (std::size_t i = 0; i < points.size(); ++i) {
    result.push_back(section_sum(points[i], share * step.segment<4>(static_cast<Eigen::Index>(4 * i))));
  }
  return result;
}

Multipliers eigenvalues(const SectionJacobian<double>& J) {
  const Eigen::Vector4cd found = J.eigenvalues();
  Multipliers sorted{found[0], found[1], found[2], found[3]};
  std::sort(sorted.begin(), sorted.end(), [](const auto& a, const auto& b) {
    const double difference = std::abs(a) - std::abs(b);
    const bool equal = std::abs(difference) <= 1e-12 * std::abs(a);  // a pair, or +-1
    return equal ? a.imag() != b.imag() ? a.imag() > b.imag() : a.real() > b.real() : difference > 0.0;
  });
  return sorted;
}

using Fine = DoubleDouble;

struct FinePoint {
  Fine phase, X, u, g1;
};

struct FineStep {
  FinePoint after;
  Fine dt, energy_loss;
};

// The state in flight after an impact.
FlightState<Fine> launched(const SpringConstants<Fine>& m, const Fine& eta, const FinePoint& p) {
  const SurfaceJet<Fine> surface = surface_jet(m.H, p.phase);
  return {p.phase, p.X, p.u - eta, surface.h - m.y0, p.g1 + surface.h1 * p.u};
}

Eigen::Vector4d difference(const FinePoint& b, const FinePoint& a) {
  const Fine phase = b.phase - a.phase;
  return {static_cast<double>(phase - Fine(nearest(phase.high()))), static_cast<double>(b.X - a.X),
          static_cast<double>(b.u - a.u), static_cast<double>(b.g1 - a.g1)};
}

// From an impact to the next, near the time `estimate` [tau].
FineStep fine_map(const Model& model, double eta, const FinePoint& point, double estimate) {
  constexpr int kNewtonSteps = 4;  // each doubles the digits: two give all 31, near a graze more are needed
  FinePoint start = point;
  if (model.kind == ModelKind::hammer) start.X = Fine(0.0), start.u = eta;
  const SpringConstants<Fine> m(model);
  const Fine drag(eta);
  const FlightState<Fine> launch = launched(m, drag, start);
  const auto gap = [&](const Fine& time) { return jet_at(m, drag, state_after(m, drag, launch, time)); };
  Fine s(estimate);
  for (int i = 0; i < kNewtonSteps; ++i) {
    const GapJet<Fine> jet = gap(s);
    s = s - jet.g / jet.g1;
  }
  const GapJet<Fine> in = gap(s);
  const Fine speed = Incidence<Fine>(m, drag, in.state, in.g1).normal_speed;
  const Fine one(1.0), e = restitution_jet(model, speed).restitution;
  const Fine kick = m.is_free_along_x * (one + e) * in.h1 * in.g1 / (one + in.h1 * in.h1);
  const FinePoint after{in.state.phase, in.state.X, drag + in.state.U + kick, -(e * in.g1)};
  return {after, s, Fine(0.5) * (one - e) * (one + e) * speed * speed};
}

// The last digits of an orbit that is known to rounding: Newton's method with residuals in double-double. Returns the
// flights from the refined points.
std::vector<FineStep> polish(const PoincareMap& map, const Shot& shot, std::vector<FinePoint>& points) {
  const std::size_t n = points.size();
  std::vector<FineStep> steps;
  constexpr int kPolishSteps = 3;  // Newton steps with a fixed matrix: each leaves an error of 1e-10 of the one before
  for (int round = 0; round <= kPolishSteps; ++round) {
    Eigen::VectorXd error(static_cast<Eigen::Index>(4 * n));
    steps.clear();
    for (std::size_t i = 0; i < n; ++i) {
      steps.push_back(fine_map(map.model(), map.eta(), points[i], shot.steps[i].dt));
      error.segment<4>(static_cast<Eigen::Index>(4 * i)) = difference(steps.back().after, points[(i + 1) % n]);
    }
    if (round == kPolishSteps) break;
    const Eigen::VectorXd step = newton_step(shot, error);
    for (std::size_t i = 0; i < n; ++i) {
      const Eigen::Vector4d d = step.segment<4>(static_cast<Eigen::Index>(4 * i));
      FinePoint& p = points[i];
      p = {p.phase + Fine(d[0]), p.X + Fine(d[1]), p.u + Fine(d[2]), p.g1 + Fine(d[3])};
    }
  }
  return steps;
}

// Refines an orbit that is known to rounding: points, energy, times and friction to the last digit.
void refine(const PoincareMap& map, const Shot& shot, const Points& known, PeriodicOrbit& orbit) {
  std::vector<FinePoint> points;
  for (const TipState& p : known) points.push_back({p.phase, p.X, p.u, p.g1});
  const std::vector<FineStep> steps = polish(map, shot, points);
  Fine energy(0.0), period(0.0);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const FinePoint& p = points[i];
    orbit.points.push_back({wrap_phase(static_cast<double>(p.phase)), static_cast<double>(p.X),
                            static_cast<double>(p.u), 0.0, static_cast<double>(p.g1)});
    orbit.times.push_back(static_cast<double>(steps[i].dt));
    energy = energy + steps[i].energy_loss;
    period = period + steps[i].dt;
  }
  const Fine eta(map.eta());
  orbit.energy_loss = static_cast<double>(energy);
  orbit.period = static_cast<double>(period);
  orbit.K_f = static_cast<double>(energy / (eta * eta * period));
}

// The point with the smallest phase first.
void turn_to_first(PeriodicOrbit& orbit) {
  const auto first = std::min_element(orbit.points.begin(), orbit.points.end(),
                                      [](const TipState& a, const TipState& b) { return a.phase < b.phase; });
  const auto shift = first - orbit.points.begin();
  std::rotate(orbit.points.begin(), orbit.points.begin() + shift, orbit.points.end());
  std::rotate(orbit.times.begin(), orbit.times.begin() + shift, orbit.times.end());
}

// Everything that does not need double-double. Precondition: every flight ends in an impact.
void measure(const PoincareMap& map, PeriodicOrbit& orbit) {
  const Shot shot = shoot(map, orbit.points);
  orbit.residual = shot.residual();
  orbit.cells = static_cast<int>(std::lround(map.eta() * orbit.period));
  orbit.slowest_impact = orbit.clearance = std::numeric_limits<double>::infinity();
  for (const MapStep& step : shot.steps) {
    orbit.speeds.push_back(step.normal_speed);
    orbit.slowest_impact = std::min(orbit.slowest_impact, step.normal_speed);
  }
  for (std::size_t i = 0; i < orbit.points.size(); ++i) {
    orbit.clearance = std::min(orbit.clearance, map.clearance(orbit.points[i], orbit.times[i]));
  }
  std::vector<SectionJacobian<double>> jacobians;
  for (const MapStep& step : shot.steps) jacobians.push_back(step.J);
  orbit.multipliers = multipliers_of(jacobians);
}

PeriodicOrbit describe(const PoincareMap& map, const Points& points, const Shot& shot) {
  PeriodicOrbit orbit;
  refine(map, shot, points, orbit);
  turn_to_first(orbit);
  measure(map, orbit);
  return orbit;
}

// Halves the step until the error falls; returns its part, or 0 if no part makes the error fall.
double damped_step(const PoincareMap& map, const Points& points, const Eigen::VectorXd& step, const Shot& now,
                   Shot& next) {
  for (double share = 1.0; share >= kSmallestShare; share *= 0.5) {
    next = shoot(map, displaced(points, step, share));
    if (next.landed && next.error.norm() < (1.0 - 0.1 * share) * now.error.norm()) return share;
  }
  return 0.0;
}

}  // namespace

// The small ones follow from the factors of the QR decomposition, in a frame that the iteration turns into the
// directions of the multipliers. Of a pair the frame turns for ever, and the modulus alone is known.
Multipliers multipliers_of(const std::vector<SectionJacobian<double>>& jacobians) {
  constexpr double kHidden = 1e-8;  // over the largest: half of the digits are left
  constexpr int kRounds = 20;       // a choice: each turns the frame by the ratio of two multipliers
  constexpr double kTurns = 0.999;  // a choice: the cosine of the last turn of a direction that is found
  SectionJacobian<double> J = SectionJacobian<double>::Identity();
  for (const SectionJacobian<double>& step : jacobians) J = step * J;
  Multipliers found = eigenvalues(J);
  if (!J.allFinite() || std::abs(found[3]) > kHidden * std::abs(found[0])) return found;
  Eigen::Matrix4d frame = Eigen::Matrix4d::Identity(), before;
  frame.col(1).swap(frame.col(3));  // the hammer has phase and gap rate alone
  Eigen::Vector4d logarithms, signs;
  for (int round = 0; round < kRounds; ++round) {
    before = frame;
    logarithms.setZero();
    signs.setOnes();
    for (const SectionJacobian<double>& step : jacobians) {
      const Eigen::HouseholderQR<Eigen::Matrix4d> qr(step * frame);
      frame = qr.householderQ();
      const Eigen::Vector4d diagonal = qr.matrixQR().diagonal();
      logarithms += diagonal.cwiseAbs().array().log().matrix();
      signs = signs.cwiseProduct(diagonal.cwiseSign());
    }
  }
  const auto is_hidden = [&](int i) {
    return std::abs(found[static_cast<std::size_t>(i)]) <= kHidden * std::abs(found[0]);
  };
  for (int i = 0; i < 4; ++i) {
    if (!is_hidden(i)) continue;
    const double turn = before.col(i).dot(frame.col(i));
    const bool is_pair = i < 3 && std::isfinite(logarithms[i + 1]) && std::abs(turn) < kTurns;
    const double logarithm = is_pair ? 0.5 * (logarithms[i] + logarithms[i + 1]) : logarithms[i];
    found[static_cast<std::size_t>(i)] = signs[i] * (turn < 0.0 ? -1.0 : 1.0) * std::exp(logarithm);
    if (is_pair) found[static_cast<std::size_t>(++i)] = std::exp(logarithm);
  }
  return found;
}

OrbitResult find_orbit(const PoincareMap& map, const std::vector<TipState>& guess) {
  Points points = guess;
  Shot shot = shoot(map, points);
  OrbitOutcome outcome = shot.landed && !points.empty() ? OrbitOutcome::slow : OrbitOutcome::singular;
  for (int i = 0; i < kMostNewtonSteps && outcome == OrbitOutcome::slow; ++i) {
    const Eigen::VectorXd step = newton_step(shot, shot.error);
    Shot next;
    const double share = step.allFinite() ? damped_step(map, points, step, shot, next) : 0.0;
    if (share > 0.0) {
      points = displaced(points, step, share);
      shot = std::move(next);
      continue;  // also below the residual: one more step gives the last digits
    }
    outcome = shot.residual() <= kFoundResidual ? OrbitOutcome::found : OrbitOutcome::singular;
  }
  if (outcome == OrbitOutcome::slow && shot.residual() <= kFoundResidual) outcome = OrbitOutcome::found;
  if (outcome != OrbitOutcome::found) return {outcome, {}};
  PeriodicOrbit orbit = describe(map, points, shot);
  // without speed the map is almost the identity on the surface: a tip in contact, not an orbit; so it is where
  // rounding leaves no flight from a point
  if ((map.eta() != 0.0 && orbit.cells == 0) || !std::isfinite(orbit.residual)) outcome = OrbitOutcome::contact;
  return {outcome, std::move(orbit)};
}

PeriodicOrbit orbit_at(const PoincareMap& map, const std::vector<TipState>& points) {
  PeriodicOrbit orbit;
  const Shot shot = shoot(map, points);
  if (!shot.landed) return orbit;
  orbit.points = points;
  for (const MapStep& step : shot.steps) {
    orbit.times.push_back(step.dt);
    orbit.period += step.dt;
    orbit.energy_loss += step.energy_loss;
  }
  orbit.K_f = orbit.energy_loss / (map.eta() * map.eta() * orbit.period);
  turn_to_first(orbit);
  measure(map, orbit);
  return orbit;
}

namespace {

// [a, a/tau] A choice: one orbit found twice agrees to the residual, 1e-13, and different orbits of one length are
// farther apart.
constexpr double kSameOrbit = 1e-7;

bool close(const TipState& a, const TipState& b) {
  return section_difference(a, b).lpNorm<Eigen::Infinity>() < kSameOrbit;
}

bool matches(const PeriodicOrbit& a, const PeriodicOrbit& b, std::size_t shift) {
  for (std::size_t i = 0; i < a.length(); ++i) {
    if (!close(a.points[i], b.points[(i + shift) % b.length()])) return false;
  }
  return true;
}

}  // namespace

bool same_orbit(const PeriodicOrbit& a, const PeriodicOrbit& b) {
  if (a.length() != b.length() || a.cells != b.cells) return false;
  for (std::size_t shift = 0; shift < a.length(); ++shift) {
    if (matches(a, b, shift)) return true;
  }
  return false;
}

bool is_prime(const PeriodicOrbit& orbit) {
  for (std::size_t shift = 1; shift < orbit.length(); ++shift) {
    if (orbit.length() % shift == 0 && matches(orbit, orbit, shift)) return false;
  }
  return true;
}

}  // namespace afm
