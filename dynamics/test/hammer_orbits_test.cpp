// The hammer's periodic orbits: closed forms, which name no tolerance but rounding.
#include <gtest/gtest.h>

#include <cmath>

#include "afm/dynamics/attractor.h"
#include "afm/dynamics/basins.h"
#include "afm/dynamics/orbit_search.h"
#include "support/models.h"

namespace afm {
namespace {

// One impact in c cells at any eta: the flight is the same backwards, so that w = 2 pi y tan(pi T) at both its ends,
// and the impact turns it round where tan(2 pi x) = -q, q = tan(pi T) (1-gamma) / (eta (1+gamma)), T = c / eta.
double orbit_K_f(const Model& m, double eta, int cells) {
  const double s = kTwoPi * m.H, e = (1.0 + m.gamma) / (1.0 - m.gamma);
  const double q = std::tan(0.5 * kTwoPi * cells / eta) / (eta * e);
  return 2.0 * e * s * s * (eta / cells) * q * q / (1.0 + q * q);
}

PeriodicOrbit orbit_of_one(const Model& m, double eta, int cells) {
  OrbitSearchSettings settings;
  settings.longest = 1;
  settings.trajectory = 2000;
  settings.guesses = 100;
  for (const FoundOrbit& f : search_orbits(PoincareMap(m, eta), settings).orbits) {
    if (f.orbit.cells == cells) return f.orbit;
  }
  return {};
}

TEST(HammerOrbits, AtEvenEtaFrictionAndMultipliersAreClosedForms) {
  for (const double gamma : {0.3, 0.5, 0.7, 0.9}) {
    for (const double eta : {2.0, 4.0, 8.0}) {
      const Model model = hammer(gamma);
      const double s = kTwoPi * model.H, after = 2.0 * gamma * s * eta / (1.0 - gamma);
      const OrbitResult r = find_orbit(PoincareMap(model, eta), {{0.755, 0.0, eta, 0.0, after * 1.01}});
      ASSERT_EQ(r.outcome, OrbitOutcome::found) << gamma << " " << eta;
      const double K_f = 4.0 * s * s * (1.0 + gamma) / (1.0 - gamma);
      EXPECT_NEAR(r.orbit.K_f, K_f, 1e-14 * K_f) << gamma << " " << eta;
      EXPECT_EQ(r.orbit.points[0].phase, 0.75);
      EXPECT_EQ(r.orbit.period, 0.5);
      EXPECT_NEAR(std::abs(r.orbit.multipliers[0]), gamma, 1e-7);  // a double root
      EXPECT_NEAR(std::abs(r.orbit.multipliers[0] * r.orbit.multipliers[1]), gamma * gamma, 1e-13);
      EXPECT_EQ(std::abs(r.orbit.multipliers[2]) + std::abs(r.orbit.multipliers[3]), 0.0);
    }
  }
}

TEST(HammerOrbits, OfOneImpactAreAClosedFormAtEveryDragVelocity) {
  struct Known {
    double eta;
    int cells;
  };
  for (const Known& known :
       {Known{1.7, 1}, Known{2.25, 1}, Known{3.4, 2}, Known{3.7, 2}, Known{4.4, 2}, Known{6.2, 3}}) {
    const Model model = hammer();
    const PeriodicOrbit orbit = orbit_of_one(model, known.eta, known.cells);
    ASSERT_EQ(orbit.length(), 1u) << known.eta;
    const double K_f = orbit_K_f(model, known.eta, known.cells);
    EXPECT_NEAR(orbit.K_f, K_f, 1e-12 * K_f) << known.eta;
    EXPECT_LE(orbit.residual, 1e-13);
  }
}

TEST(HammerOrbits, ATipIsDrawnToThem) {
  const Model model = hammer();
  const Attractor a = find_attractor(model, 3.4, to_tip_state(model.H, {0.25, 0.0, 0.2, 3.4, 0.0}));
  EXPECT_EQ(a.name(), "period-1");
  EXPECT_EQ(a.cells, 2);
  EXPECT_LT(a.lyapunov.exponents[0], 0.0);
  EXPECT_NEAR(a.lyapunov.exponents[0] + a.lyapunov.exponents[1], 2.0 * std::log(0.7) / (2.0 / 3.4), 1e-9);
  BasinSettings settings;
  settings.starts = 10;
  settings.friction_duration = 100.0;
  const std::vector<Basin> basins = find_basins({2.0, 0.7, 0.05, ModelKind::hammer}, settings);
  EXPECT_NEAR(basins.front().first.K_f, orbit_K_f(model, 2.0 + 1e-15, 1), 1e-12 * basins.front().first.K_f);
}

}  // namespace
}  // namespace afm
