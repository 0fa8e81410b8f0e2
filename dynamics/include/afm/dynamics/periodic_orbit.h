// Periodic orbits of the impact map (paper, section VIII), stable or unstable, with their periods, friction and
// multipliers. Newton's method on all points at once (multiple shooting) finds them. Natural units.
#pragma once

#include <array>
#include <complex>
#include <cstdint>
#include <vector>

#include "poincare_map.h"

namespace afm {

using Multipliers = std::array<std::complex<double>, 4>;  // largest first; of a pair, that with positive imaginary part

// The eigenvalues of the product J_n ... J_1 around an orbit. Guarantee: small ones too have the accuracy of the
// Jacobians; rounding would hide them in the product. Of a small pair that is the modulus.
Multipliers multipliers_of(const std::vector<SectionJacobian<double>>& jacobians);

struct PeriodicOrbit {
  std::vector<TipState> points;  // just after each impact; the first has the smallest phase
  std::vector<double> times;     // of the flights from each to the next [tau]
  int cells = 0;                 // that the holder passes in a period; negative for a negative drag velocity
  double period = 0.0;           // [tau]: the sum of the times, which is cells / eta
  double energy_loss = 0.0;      // in a period [m_tip a^2/tau^2]
  double K_f = 0.0;              // [m_tip/tau]; NaN at eta = 0
  double residual = 0.0;         // largest |map(point) - next point| in any coordinate, of points that are rounded
  Multipliers multipliers{};
  std::vector<double> speeds;   // normal speeds of the impacts at their ends [a/tau]
  double slowest_impact = 0.0;  // the least of them; the law has a corner at the cutoff
  double clearance = 0.0;       // smallest gap at a minimum on the way [a]; at 0 the orbit grazes

  std::size_t length() const { return points.size(); }
};

enum class OrbitOutcome : std::uint8_t {
  found,     // the residual was at most 1e-13 before the last refinement
  contact,   // the orbit has shrunk to bounces without speed
  singular,  // no solution nearby: a multiplier is 1, or all steps leave the section
  slow       // the step limit came first
};

struct OrbitResult {
  OrbitOutcome outcome = OrbitOutcome::slow;
  PeriodicOrbit orbit;  // the last state of the search
};

// From a first estimate of each point, in order. Guarantee: points, period and K_f of an orbit found are exact to the
// last digit, by refinement in double-double. The multipliers have the accuracy of the Jacobians in double, the small
// ones of a long orbit too.
OrbitResult find_orbit(const PoincareMap& map, const std::vector<TipState>& guess);

// An orbit from known points, which stay as they are; its residual measures their error. Empty if a flight has no
// impact.
PeriodicOrbit orbit_at(const PoincareMap& map, const std::vector<TipState>& points);

// True: b has the points of a, starting with another one.
bool same_orbit(const PeriodicOrbit& a, const PeriodicOrbit& b);

// True: the orbit is not a repeated shorter orbit.
bool is_prime(const PeriodicOrbit& orbit);

}  // namespace afm
