#include "bifurcation_signs.h"

#include <algorithm>
#include <cmath>
#include <complex>

namespace afm {
namespace {

// a choice: distance of a multiplier from where it passes, at an event found by bisection
constexpr double kOnCircle = 1e-3;

double characteristic(const Multipliers& m, double root) {
  return std::real((m[0] - root) * (m[1] - root) * (m[2] - root) * (m[3] - root));
}

bool has_near(const Multipliers& m, double root) {
  return std::any_of(m.begin(), m.end(), [&](const auto& z) { return std::abs(z - root) < kOnCircle; });
}

}  // namespace

int bifurcation_sign(BifurcationKind kind, const PeriodicOrbit& orbit, double v_c) {
  const Multipliers& m = orbit.multipliers;
  switch (kind) {
    case BifurcationKind::corner:
      return orbit.slowest_impact < v_c ? -1 : 1;
    case BifurcationKind::saddle_node:
      return characteristic(m, 1.0) < 0.0 ? -1 : 1;
    case BifurcationKind::period_doubling:
      return characteristic(m, -1.0) < 0.0 ? -1 : 1;
    default:
      return static_cast<int>(
          std::count_if(m.begin(), m.end(), [](const auto& z) { return z.imag() != 0.0 && std::abs(z) > 1.0; }));
  }
}

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

double turns_on_circle(const PeriodicOrbit& orbit) {
  for (const std::complex<double>& z : orbit.multipliers) {
    if (z.imag() > 0.0 && std::abs(std::abs(z) - 1.0) < kOnCircle) return std::arg(z) / kTwoPi;
  }
  return 0.0;
}

}  // namespace afm
