#include "afm/dynamics/continuation.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "afm/dynamics/orbit_search.h"
#include "support/models.h"

namespace afm {
namespace {

// Just after an impact of the orbit at even eta: mid-height of the rising flank. Each impact kicks the horizontal
// spring by -2 U, and half a tau later finds it as it was.
TipState closed_point(double eta, double gamma) {
  const double s = kTwoPi * Model().H, N = std::sqrt(1.0 + s * s), speed = 2.0 * eta * s / ((1.0 - gamma) * N);
  const double U = -s * (1.0 + gamma) * speed / (2.0 * N), omega = kTwoPi * Model().frequency_ratio;
  return {0.75, U / omega / std::tan(0.25 * omega), eta + U, 0.0, gamma * speed * N};
}

PeriodicOrbit orbit_at(double eta, double gamma, std::size_t length) {
  OrbitSearchSettings settings;
  settings.longest = static_cast<int>(length);
  settings.trajectory = 20000;
  settings.guesses = 200;
  return search_orbits(PoincareMap(model_with(gamma, Model().v_c), eta), settings).orbits.back().orbit;
}

const BranchEvent* find(const Branch& branch, BifurcationKind kind) {
  const auto found = std::find_if(branch.events.begin(), branch.events.end(),
                                  [&](const BranchEvent& event) { return event.kind == kind; });
  return found == branch.events.end() ? nullptr : &*found;
}

PeriodicOrbit even_orbit(double eta) {
  const OrbitResult r = find_orbit(PoincareMap(Model(), eta), {closed_point(eta, Model().gamma)});
  EXPECT_EQ(r.outcome, OrbitOutcome::found);
  return r.orbit;
}

TEST(Continuation, FollowsTheClosedFormDownToWhereItGrazes) {
  const Branch branch = continue_orbit(Model(), 2.0, even_orbit(2.0), Parameter::gamma, 0.1);
  EXPECT_EQ(branch.end, BranchEnd::grazing);
  for (const BranchPoint& point : branch.points) {
    ASSERT_NEAR(point.orbit.K_f, even_K_f(point.parameter), 1e-9) << point.parameter;
  }
  const BranchEvent* graze = find(branch, BifurcationKind::grazing);
  ASSERT_NE(graze, nullptr);
  // a flight from the closed form, at the gamma where the branch ended: it touches to within rounding
  const double gamma = graze->at.parameter;
  const Flight<double> flight(SpringConstants<double>(Model()), 2.0, closed_point(2.0, gamma));
  double smallest = INFINITY;
  for (int i = 2000; i < 98000; ++i) smallest = std::min(smallest, flight.gap(0.5 * i / 100000.0).g);
  EXPECT_NEAR(smallest, 0.0, 1e-8);
  EXPECT_NEAR(gamma, 0.305677576, 1e-8);
}

TEST(Continuation, EventsLieOnTheUnitCircle) {
  const Branch up = continue_orbit(Model(), 2.0, even_orbit(2.0), Parameter::eta, 3.0);
  const BranchEvent* torus = find(up, BifurcationKind::torus);
  ASSERT_NE(torus, nullptr);
  EXPECT_NEAR(std::abs(torus->at.orbit.multipliers[0]), 1.0, 1e-7);
  EXPECT_NEAR(std::cos(kTwoPi * torus->turns), torus->at.orbit.multipliers[0].real(), 1e-6);
  const Branch down = continue_orbit(Model(), 2.0, even_orbit(2.0), Parameter::eta, 1.0);
  const BranchEvent* doubling = find(down, BifurcationKind::period_doubling);
  ASSERT_NE(doubling, nullptr);
  EXPECT_LE(std::abs(doubling->at.orbit.multipliers[0] + 1.0), 1e-7);
}

// The pair that leaves the circle is real before the next point of the branch.
TEST(Continuation, ATorusThatSoonSplitsIsFound) {
  const Branch up = continue_orbit(Model(), 2.4, orbit_at(2.4, 0.7, 1), Parameter::eta, 3.2);
  const auto torus = std::find_if(up.events.begin(), up.events.end(), [](const BranchEvent& event) {
    return event.kind == BifurcationKind::torus && std::abs(event.at.parameter - 3.12354) < 2e-5;
  });
  ASSERT_NE(torus, up.events.end());
  EXPECT_NEAR(std::abs(torus->at.orbit.multipliers[0]), 1.0, 1e-5);
}

// Behind it there is no such parameter.
TEST(Continuation, ATargetMayBeTheEndOfTheRange) {
  const Branch stiff = continue_orbit(Model(), 2.0, even_orbit(2.0), Parameter::cutoff, 0.0);
  EXPECT_EQ(stiff.end, BranchEnd::target);
  EXPECT_EQ(stiff.points.back().parameter, 0.0);
  const Branch lossless = continue_orbit(Model(), 2.3, orbit_at(2.3, 0.7, 1), Parameter::gamma, 1.0);
  EXPECT_EQ(lossless.end, BranchEnd::target);
}

// An orbit of three impacts and one of four meet where the fourth has no speed, and neither goes on.
TEST(Continuation, TwoOrbitsDieInOneGraze) {
  const Branch three = continue_orbit(Model(), 3.4, orbit_at(3.4, 0.7, 3), Parameter::eta, 5.0);
  const Branch four = continue_orbit(Model(), 3.4, orbit_at(3.4, 0.7, 4), Parameter::eta, 5.0);
  ASSERT_EQ(three.end, BranchEnd::grazing);
  ASSERT_EQ(four.end, BranchEnd::grazing);
  const BranchPoint &a = three.points.back(), &b = four.points.back();
  EXPECT_NEAR(a.parameter, b.parameter, 2e-6);
  EXPECT_NEAR(a.orbit.K_f, b.orbit.K_f, 1e-4);
  EXPECT_LE(a.orbit.clearance, 1e-9);
  EXPECT_NE(find(four, BifurcationKind::saddle_node), nullptr);  // it comes back from a fold
  EXPECT_NE(find(four, BifurcationKind::corner), nullptr);
}

// Why there is no orbit of two impacts at eta = 3.4: the one born in the period doubling at 3.2938 grazes and ends
// before.
TEST(Continuation, TheOrbitOfTwoImpactsEndsShortOfThePapersDrag) {
  const PeriodicOrbit two = orbit_at(3.3, 0.7, 2);
  ASSERT_EQ(two.length(), 2u);
  const Branch up = continue_orbit(Model(), 3.3, two, Parameter::eta, 3.4);
  ASSERT_EQ(up.end, BranchEnd::grazing);
  EXPECT_NEAR(up.points.back().parameter, 3.3359068, 1e-6);
  // towards its birth it went round and back on itself, to the graze
  const Branch down = continue_orbit(Model(), 3.3, two, Parameter::eta, 3.0);
  EXPECT_EQ(down.end, BranchEnd::period_doubling);
  EXPECT_NEAR(down.points.back().parameter, 3.2937849, 1e-3);
  const Branch one = continue_orbit(Model(), 3.4, orbit_at(3.4, 0.7, 1), Parameter::eta, 3.2);
  const BranchEvent* doubling = find(one, BifurcationKind::period_doubling);
  ASSERT_NE(doubling, nullptr);
  EXPECT_NEAR(doubling->at.parameter, 3.2937849, 1e-6);
}

}  // namespace
}  // namespace afm
