#include "afm/dynamics/periodic_orbit.h"

#include <gtest/gtest.h>

#include <cmath>
#include <tuple>
#include <vector>

#include "afm/dynamics/attractor.h"
#include "afm/dynamics/orbit_search.h"
#include "afm/tip.h"
#include "support/models.h"

namespace afm {
namespace {

// eta = 3.4, gamma = 0.7, computed in 128-bit floats.
TEST(PeriodicOrbit, ThePapersOrbitComesOutToAllDigits) {
  const Model model = model_with_cutoff(0.05);
  const OrbitResult r = find_orbit(PoincareMap(model, 3.4), {{0.53, 0.0, 3.2, 0.0, 2.5}});
  ASSERT_EQ(r.outcome, OrbitOutcome::found);
  const PeriodicOrbit& orbit = r.orbit;
  EXPECT_LE(orbit.residual, 1e-13);
  EXPECT_EQ(orbit.cells, 2);
  EXPECT_EQ(orbit.period, 2.0 / 3.4);
  EXPECT_EQ(orbit.K_f, 0.22902622884216517);
  const FreeState first = to_free_state(model.H, orbit.points[0]);
  EXPECT_NEAR(first.phase, 0.5290552555567710, 6e-17);  // sixteen digits are given
  EXPECT_NEAR(first.X, 0.0036110865500110, 6e-17);
  EXPECT_NEAR(first.u, 3.1709737711578348, 4.5e-16);  // an ulp
  EXPECT_NEAR(first.w, 2.0880897958488404, 9e-16);    // two: from gap rate and slope
  const std::complex<double> expected[] = {{-0.5274355542, 1.396024991},
                                           {-0.5274355542, -1.396024991},
                                           {-0.2232941408, 0.4125037623},
                                           {-0.2232941408, -0.4125037623}};
  for (std::size_t i = 0; i < 4; ++i) EXPECT_LE(std::abs(orbit.multipliers[i] - expected[i]), 6e-10) << i;
}

// Two impacts per tau at the rising flank, each the same: K_f = 4 (1+gamma)/(1-gamma) s^2/(1+s^2). The horizontal
// frequency is not in it: it bends the flights, not the impacts.
TEST(PeriodicOrbit, AtEvenEtaIsTheClosedFormWhateverTheHorizontalFrequency) {
  const double cases[][2] = {{2.0, 6.25}, {4.0, 6.25}, {6.0, 6.25}, {4.0, 4.3}, {4.0, 5.1}, {4.0, 7.3}, {4.0, 9.7}};
  for (const auto& [eta, ratio] : cases) {
    Model model = model_with_cutoff(0.05);
    model.frequency_ratio = ratio;
    const double s = kTwoPi * model.H, N = std::sqrt(1.0 + s * s), before = 2.0 * eta * s / (0.3 * N);  // normal speed
    const double U = -s * 1.7 * before / (2.0 * N), omega = kTwoPi * ratio;
    const TipState guess{0.75, U / omega / std::tan(0.25 * omega), eta + U, 0.0, 0.7 * before * N + 0.01};
    const OrbitResult r = find_orbit(PoincareMap(model, eta), {guess});
    ASSERT_EQ(r.outcome, OrbitOutcome::found) << eta << ' ' << ratio;
    EXPECT_NEAR(r.orbit.K_f, 4.0 * 1.7 / 0.3 * s * s / (1.0 + s * s), 4e-15) << eta << ' ' << ratio;
    EXPECT_EQ(r.orbit.period, 0.5);
    EXPECT_NEAR(r.orbit.slowest_impact, before, 1e-12);
  }
}

TEST(PeriodicOrbit, DraggedBackwardsItIsMirrored) {
  const Model model = model_with_cutoff(0.05);
  const OrbitResult forth = find_orbit(PoincareMap(model, 3.4), {{0.53, 0.0, 3.2, 0.0, 2.5}});
  const OrbitResult back = find_orbit(PoincareMap(model, -3.4), {{0.47, 0.0, -3.2, 0.0, 2.5}});
  ASSERT_EQ(back.outcome, OrbitOutcome::found);
  EXPECT_EQ(back.orbit.cells, -forth.orbit.cells);
  EXPECT_NEAR(back.orbit.points[0].phase, 1.0 - forth.orbit.points[0].phase, 1e-15);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_LE(std::abs(back.orbit.multipliers[i] - forth.orbit.multipliers[i]), 1e-12) << i;
  }
}

// Whichever impact of the attractor at eta = 3.5 comes first.
TEST(PeriodicOrbit, EachTimeIsThatOfTheFlightFromItsPoint) {
  const PoincareMap map(model_with_cutoff(0.05), 3.5);
  Tip tip(map.model(), map.eta(), start_at(map.eta()));
  while (tip.advance({2000, 0.0}) != Outcome::time_limit) continue;
  for (int first = 0; first < 4; ++first) {
    std::vector<TipState> points;
    for (Tip next = tip; points.size() < 4; points.push_back(next.tip_state())) next.advance(kEndOfTime);
    const OrbitResult r = find_orbit(map, points);
    ASSERT_EQ(r.outcome, OrbitOutcome::found);
    EXPECT_TRUE(is_prime(r.orbit));
    EXPECT_GT(r.orbit.clearance, 0.0);
    for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(r.orbit.times[i], map(r.orbit.points[i]).dt, 1e-13) << i;
    tip.advance(kEndOfTime);
  }
}

std::complex<double> product(const Multipliers& m) { return m[0] * m[1] * m[2] * m[3]; }

// The product of the multipliers is the volume that the impacts leave.
TEST(PeriodicOrbit, MultipliersMultiplyToTheRestitutions) {
  OrbitSearchSettings settings;
  settings.longest = 5;
  settings.trajectory = 20000;
  settings.guesses = 100;
  const Model model = model_with_cutoff(0.05);
  for (const FoundOrbit& found : search_orbits(PoincareMap(model, 3.4), settings).orbits) {
    ASSERT_GE(found.orbit.slowest_impact, model.v_c);
    const double volume = std::pow(model.gamma, 2.0 * static_cast<double>(found.orbit.length()));
    EXPECT_NEAR(product(found.orbit.multipliers).real(), volume, 1e-11) << found.orbit.length();
    EXPECT_NEAR(found.orbit.period, found.orbit.cells / 3.4, 1e-13);
  }
}

// Rounding hides the least in the product of so many Jacobians: it was 4e8 times as large. The hammer has two.
TEST(PeriodicOrbit, TheLeastMultiplierOfALongOrbitIsKnownToo) {
  OrbitSearchSettings settings;
  settings.longest = 23;
  settings.trajectory = 20000;
  settings.guesses = 30;
  for (const Model& model : {model_with_cutoff(0.05), hammer()}) {
    const bool is_free = model.kind == ModelKind::oscillator;
    int seen = 0;
    for (const FoundOrbit& found : search_orbits(PoincareMap(model, is_free ? 3.4 : 3.2), settings).orbits) {
      if (found.orbit.length() < 9 || found.orbit.slowest_impact < model.v_c) continue;
      const Multipliers& m = found.orbit.multipliers;
      const double volume = std::pow(model.gamma, 2.0 * static_cast<double>(found.orbit.length()));
      EXPECT_NEAR((is_free ? product(m) : m[0] * m[1]).real() / volume, 1.0, 1e-4) << found.orbit.length();
      ++seen;
    }
    EXPECT_GT(seen, 10) << name(model.kind);
  }
}

TEST(PeriodicOrbit, IsTheSameFromAnyOfItsPoints) {
  OrbitSearchSettings settings;
  settings.longest = 3;
  settings.trajectory = 20000;
  settings.guesses = 200;
  const PoincareMap map(model_with_cutoff(0.05), 3.4);
  const OrbitSearchResult found = search_orbits(map, settings);
  PeriodicOrbit three = found.orbits.back().orbit;
  ASSERT_EQ(three.length(), 3u);
  PeriodicOrbit rotated = three;
  std::rotate(rotated.points.begin(), rotated.points.begin() + 1, rotated.points.end());
  EXPECT_TRUE(same_orbit(three, rotated));
  EXPECT_TRUE(is_prime(three));
  std::swap(rotated.points[0], rotated.points[1]);
  EXPECT_FALSE(same_orbit(three, rotated));
  const PeriodicOrbit& one = found.orbits.front().orbit;
  ASSERT_EQ(one.length(), 1u);
  const OrbitResult twice = find_orbit(map, {one.points[0], one.points[0]});
  ASSERT_EQ(twice.outcome, OrbitOutcome::found);
  EXPECT_FALSE(is_prime(twice.orbit));
}

TEST(PeriodicOrbit, BouncesWithoutSpeedAreNone) {
  const OrbitResult r = find_orbit(PoincareMap(model_with_cutoff(0.05), 3.4), {{0.5, 0.0, 3.4, 0.0, 1e-12}});
  EXPECT_NE(r.outcome, OrbitOutcome::found);
}

// An impact at gamma = 0 leaves no speed, but the surface falls away. The map had no flight from there: residuals were
// infinite, and multipliers 1.
TEST(PeriodicOrbit, WithoutRestitutionItIsThatOfTheAttractor) {
  const std::vector<std::tuple<ModelKind, double, double>> known{
      {ModelKind::hammer, 0.02, 1.05},     {ModelKind::hammer, 0.02, 2.35},     {ModelKind::oscillator, 0.02, 2.22},
      {ModelKind::oscillator, 0.05, 0.95}, {ModelKind::oscillator, 0.05, 1.11}, {ModelKind::oscillator, 0.05, 1.12}};
  for (const auto& [kind, height, eta] : known) {
    Model model = model_with_cutoff(0.05);
    model.kind = kind;
    model.gamma = 0.0;
    model.y0 = height;
    Tip tip(model, eta, FreeState{0.25, 0.0, 0.2, eta, 0.0});
    const Attractor attractor = find_attractor(model, tip, AttractorSettings{});
    ASSERT_EQ(attractor.name(), "period-1") << eta;
    while (tip.advance(kEndOfTime) != Outcome::impact) continue;
    const OrbitResult r = find_orbit(PoincareMap(model, eta), {tip.tip_state()});
    ASSERT_EQ(r.outcome, OrbitOutcome::found) << eta;
    EXPECT_LE(r.orbit.residual, 1e-13) << eta;
    EXPECT_GT(r.orbit.clearance, 0.0) << eta;
    const double multiplier = std::exp(attractor.lyapunov.exponents[0] * r.orbit.period);
    EXPECT_NEAR(std::abs(r.orbit.multipliers[0]), multiplier, 1e-6) << eta;
  }
}

// Lengths 1, 1, 3, 4, 5, 6 and none of length 2, whatever guesses are taken.
TEST(OrbitSearch, FindsTheSameOrbitsFromOtherGuesses) {
  for (const std::uint64_t seed : {1u, 2u}) {
    OrbitSearchSettings settings;
    settings.trajectory = 30000;
    settings.guesses = 300;
    settings.seed = seed;
    const OrbitSearchResult found = search_orbits(PoincareMap(model_with_cutoff(0.05), 3.4), settings);
    std::vector<std::size_t> lengths;
    for (const FoundOrbit& orbit : found.orbits) {
      lengths.push_back(orbit.orbit.length());
      EXPECT_LE(orbit.orbit.residual, 1e-13);
    }
    EXPECT_EQ(lengths, (std::vector<std::size_t>{1, 1, 3, 4, 5, 6})) << seed;
    EXPECT_EQ(found.lengths[1].prime, 0);
    EXPECT_GT(found.lengths[1].repeats, 100);
  }
}

}  // namespace
}  // namespace afm
