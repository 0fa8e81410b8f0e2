#include "afm/dynamics/poincare_map.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "afm/landing.h"
#include "afm/reflection.h"

namespace afm {

TipState PoincareMap::constrained(const TipState& start) const {
  return model_.kind == ModelKind::oscillator ? start : TipState{start.phase, 0.0, eta_, start.g, start.g1};
}

MapStep PoincareMap::operator()(const TipState& start) const {
  MapStep step;
  if (!(start.g1 > -kMinGapRate) || !std::isfinite(start.g1 + start.u + start.X + start.phase)) return step;
  TipState launch = constrained(start);
  if (start.g1 < kMinGapRate) launch.g1 = 0.0;
  Flight<double> flight(springs_, eta_, launch);
  if (launch.g1 == 0.0 && !(flight.gap(0.0).g2 > 0.0)) return step;
  const Landing<double> landing = find_landing(model_, flight, kLongestMapFlight);
  step.outcome = MapOutcome::no_impact;
  if (landing.outcome != SearchOutcome::impact || !(landing.jet.g1 < 0.0)) return step;
  const Reflection bounce = reflect(model_, eta_, landing.jet);
  step.outcome = MapOutcome::impact;
  step.after = bounce.after;
  step.dt = landing.s;
  step.normal_speed = bounce.normal_speed;
  step.tangential_velocity = bounce.tangential_velocity;
  step.energy_loss = bounce.energy_loss;
  step.J = section_jacobian(model_, flight, landing.s, landing.jet);
  return step;
}

// On a grid of 32 points a turn of the fastest term of the gap, then by bisection.
double PoincareMap::clearance(const TipState& start, double dt) const {
  const Flight<double> flight(springs_, eta_, constrained(start));
  const double turns = dt * (springs_.ratio + std::abs(eta_) + 1.0);
  const int points = static_cast<int>(std::min(1e5, std::ceil(32.0 * turns))) + 8;
  double smallest = std::numeric_limits<double>::infinity();
  for (int i = 2; i < points; ++i) {  // at its launch the tip rises
    double low = dt * (i - 1) / points, high = dt * i / points;
    if (!(flight.gap(low).g1 <= 0.0 && flight.gap(high).g1 > 0.0)) continue;
    constexpr int kBisections = 40;  // the gap at a minimum is then exact to rounding: its error is of the second order
    for (int k = 0; k < kBisections; ++k) {
      const double middle = 0.5 * (low + high);
      (flight.gap(middle).g1 > 0.0 ? high : low) = middle;
    }
    smallest = std::min(smallest, flight.gap(low).g);
  }
  return smallest;
}

Eigen::Vector4d section_difference(const TipState& b, const TipState& a) {
  const double phase = b.phase - a.phase;
  return {phase - std::round(phase), b.X - a.X, b.u - a.u, b.g1 - a.g1};
}

TipState section_sum(const TipState& a, const Eigen::Vector4d& step) {
  return {wrap_phase(a.phase + step[0]), a.X + step[1], a.u + step[2], 0.0, a.g1 + step[3]};
}

}  // namespace afm
