// Averages over a chaotic attractor from its periodic orbits (periodic orbit theory): K_f = <dE> / (eta^2 <dt>), Eq. 7
// of the paper. Precondition: all orbits of the attractor up to a length are known. The convergence is fast if longer
// orbits are nearly combinations of shorter ones. The deviation from flow conservation measures both.
#pragma once

#include <vector>

#include "periodic_orbit.h"

namespace afm {

struct CycleAverage {
  int order = 0;              // truncation: impacts
  int terms = 0;              // orbits and combinations of orbits used
  double K_f = 0.0;           // [m_tip/tau]; NaN if it is not defined
  double conservation = 0.0;  // 0 by flow conservation: 1/zeta(1), or the determinant at 1
};

// 1/zeta = prod (1 - t_p), t_p = 1/|product of expanding multipliers|: combinations of at most N impacts, N = 1 to
// longest.
std::vector<CycleAverage> zeta_averages(const std::vector<PeriodicOrbit>& orbits, double eta, int longest);

// det(1 - zL) = exp(-sum z^(nr)/r / |det(1 - J^r)|), cut after z^N, taken at z = 1.
std::vector<CycleAverage> determinant_averages(const std::vector<PeriodicOrbit>& orbits, double eta, int longest);

}  // namespace afm
