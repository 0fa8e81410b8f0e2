// Periodic orbits of the impact map, stable or not: found by Newton's method on all their points at once (multiple
// shooting), with their periods, friction and multipliers.
#pragma once

#include <array>
#include <complex>
#include <cstdint>
#include <vector>

#include "poincare_map.h"

namespace afm {

using Multipliers = std::array<std::complex<double>, 4>;  // largest first; of a pair, that with positive imaginary part

struct PeriodicOrbit {
  std::vector<TipState> points;  // just after each impact; the first has the smallest phase
  std::vector<double> times;     // of the flights from each to the next [tau]
  int cells = 0;                 // passed by the holder in a period; negative where it is dragged back
  double period = 0.0;           // [tau]: the sum of the times, which is cells / eta
  double energy_loss = 0.0;      // in a period [m a^2/tau^2]
  double K_f = 0.0;              // [m/tau]; NaN at eta = 0
  double residual = 0.0;         // largest |map(point) - next point| in any coordinate
  Multipliers multipliers{};
  double slowest_impact = 0.0;  // normal speed [a/tau]: where it meets the cutoff the law has a corner
  double clearance = 0.0;       // smallest gap at a minimum on the way [a]: where it is 0 the orbit grazes

  std::size_t length() const { return points.size(); }
};

enum class OrbitOutcome : std::uint8_t {
  found,
  contact,   // it has shrunk to bounces without speed
  singular,  // the equations have no solution nearby: a multiplier is 1, or all steps lead out of the section
  slow       // steps ran out before the residual was reached
};

struct OrbitResult {
  OrbitOutcome outcome = OrbitOutcome::slow;
  PeriodicOrbit orbit;  // as far as it got
};

struct NewtonSettings {
  double residual = 1e-13;
  int most_steps = 60;
  // Steps are cut down until the residual falls: Newton's method then follows the flow d(error)/dt = -error that the
  // variational method follows, and converges quadratically at its end.
  double smallest_share = 1e-3;
};

// From a guess of each of its points, in order. Points, period and K_f of an orbit found are right to the last digit
// (they are refined in double-double), multipliers as the double Jacobians at these points give them.
OrbitResult find_orbit(const PoincareMap& map, const std::vector<TipState>& guess, const NewtonSettings& settings = {});

// An orbit whose points are known, as they are: the residual shows how good they are. Empty where a point does
// not land.
PeriodicOrbit orbit_at(const PoincareMap& map, const std::vector<TipState>& points);

// Its Jacobian from each point all around: product of those of the flights.
SectionJacobian<double> orbit_jacobian(const PoincareMap& map, const PeriodicOrbit& orbit);

// Whether b is a with its points counted from another one.
bool same_orbit(const PeriodicOrbit& a, const PeriodicOrbit& b);

// Whether no shorter orbit, repeated, is the same.
bool is_prime(const PeriodicOrbit& orbit);

}  // namespace afm
