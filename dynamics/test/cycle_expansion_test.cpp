#include "afm/dynamics/cycle_expansion.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "afm/dynamics/orbit_search.h"

namespace afm {
namespace {

bool is_least_rotation(const std::string& word) {
  for (std::size_t i = 1; i < word.size(); ++i) {
    if (word.substr(i) + word.substr(0, i) <= word) return false;  // equal: a repeat
  }
  return true;
}

// All prime orbits of the map that expands by the factor `expansion`, of `symbols` equal branches: branch k takes time
// 1 + k, energy 5 - k.
std::vector<PeriodicOrbit> full_shift(double expansion, std::size_t longest) {
  std::vector<PeriodicOrbit> orbits;
  for (std::size_t n = 1; n <= longest; ++n) {
    for (std::size_t bits = 0; bits < (std::size_t{1} << n); ++bits) {
      std::string word;
      PeriodicOrbit orbit;
      for (std::size_t i = 0; i < n; ++i) {
        const double k = static_cast<double>((bits >> i) & 1u);
        word += static_cast<char>('0' + static_cast<int>(k));
        orbit.points.push_back({});
        orbit.period += 1.0 + k;
        orbit.energy_loss += 5.0 - k;
      }
      orbit.multipliers[0] = std::pow(expansion, static_cast<double>(n));
      if (is_least_rotation(word)) orbits.push_back(orbit);
    }
  }
  return orbits;
}

// Two branches of slope 2: the curvatures cancel, and (5 + 4) / (1 + 2) is exact from the two fixed points on.
TEST(CycleExpansion, OfTheFullShiftIsExactAtEveryOrder) {
  const double eta = 2.0, exact = 9.0 / 3.0 / (eta * eta);
  for (const CycleAverage& row : zeta_averages(full_shift(2.0, 6), eta, 6)) {
    EXPECT_NEAR(row.K_f, exact, 1e-13) << row.order;
    EXPECT_NEAR(row.conservation, 0.0, 1e-14) << row.order;
  }
}

// det(1 - zL) = prod_k (1 - z / 2^k): its coefficients fall faster than exponentially.
TEST(CycleExpansion, DeterminantOfTheFullShiftConvergesFasterThanExponentially) {
  const std::vector<CycleAverage> rows = determinant_averages(full_shift(2.0, 8), 1.0, 8);
  double value = 1.0, product = 1.0;
  for (int n = 1; n <= 8; ++n) {
    product *= -std::pow(0.5, n - 1) / (1.0 - std::pow(0.5, n));  // Euler's expansion of the product
    value += product;
    EXPECT_NEAR(rows[static_cast<std::size_t>(n - 1)].conservation, value, 1e-12) << n;
  }
  EXPECT_NEAR(rows.back().K_f, 3.0, 1e-6);
}

// The paper's attractor: orbits up to six impacts come within 3 % of direct simulation, 0.2531; the first alone misses
// 10 %.
TEST(CycleExpansion, OfThePapersAttractorComesNearToSimulation) {
  OrbitSearchSettings settings;
  settings.trajectory = 50000;
  settings.guesses = 500;
  std::vector<PeriodicOrbit> orbits;
  for (const FoundOrbit& found : search_orbits(PoincareMap(Model(), 3.4), settings).orbits) {
    if (found.approach < 0.1) orbits.push_back(found.orbit);
  }
  ASSERT_EQ(orbits.size(), 5u);
  constexpr double kSimulated = 0.2531;
  EXPECT_NEAR(zeta_averages(orbits, 3.4, 6).back().K_f, kSimulated, 0.03 * kSimulated);
  EXPECT_NEAR(determinant_averages(orbits, 3.4, 6).back().K_f, kSimulated, 0.03 * kSimulated);
  EXPECT_GT(std::abs(orbits.front().K_f - kSimulated), 0.08 * kSimulated);
}

}  // namespace
}  // namespace afm
