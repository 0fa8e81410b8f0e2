// The hammer's Jacobians: those of its own two dimensions, phase and gap rate, against quad precision and the laws of
// volume.
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>

#include "afm/dynamics/lyapunov.h"
#include "afm/dynamics/poincare_map.h"
#include "support/models.h"
#include "support/quad_impacts.h"
#include "trials/random_launches.h"

namespace afm {
namespace {

// above, around and below the cutoff; with the fold of the law (gamma < 1/2); elastic
const Model kModels[] = {hammer(0.7, 0.0), hammer(0.7, 0.5), hammer(0.7, 20.0), hammer(0.3, 5.0), hammer(1.0, 0.05)};

struct Bounce {
  double eta;
  TipState start;
  MapStep step;
};

Bounce next(const Model& model, RandomLaunches& random) {
  for (;;) {
    const double eta = random.within(-9.0, 9.0);
    const TipState start = random.next(eta, -4.0, 1.0);
    const MapStep step = PoincareMap(model, eta)(start);
    if (step.outcome == MapOutcome::impact) return {eta, start, step};
  }
}

TEST(HammerJacobian, IsTheDerivativeOfTheMap) {
  for (const Model& model : kModels) {
    RandomLaunches random(1);
    int below_cutoff = 0;
    for (int i = 0; i < 2000; ++i) {
      const Bounce b = next(model, random);
      QuadImpacts exact(model, b.eta);
      const auto map = [&](const QuadPoint& p) { return exact.next(p, b.step.dt); };
      const Eigen::Matrix4d truth = quad_differences<4>(map, quad_point(b.start), Quad(1e-13));
      below_cutoff += exact.speed() < model.v_c ? 1 : 0;
      ASSERT_LE(relative_distance(b.step.J, truth), 1e-9) << "impact " << i << ", gap rate " << exact.speed();
      ASSERT_EQ(b.step.J.row(1).norm() + b.step.J.row(2).norm(), 0.0);
      ASSERT_EQ(b.step.after.X, 0.0);
      ASSERT_EQ(b.step.after.u, b.eta);
    }
    EXPECT_GE(below_cutoff, model.v_c >= 0.5 ? 100 : 0) << "v_c " << model.v_c;
  }
}

// The area of phase and gap rate shrinks by restitution and slope of the law, over the rates at which the flow
// crosses.
TEST(HammerJacobian, ShrinksAreaByTheRestitutionAlone) {
  for (const Model& model : kModels) {
    RandomLaunches random(2);
    for (int i = 0; i < 2000; ++i) {
      const Bounce b = next(model, random);
      const RestitutionJet<double> law = restitution_jet(model, b.step.normal_speed);
      const double expected = law.slope * law.restitution * b.start.g1 / b.step.after.g1;
      const SectionJacobian<double>& J = b.step.J;
      const double area = J(0, 0) * J(3, 3) - J(0, 3) * J(3, 0);
      ASSERT_NEAR(area, expected, 1e-11 * (std::abs(expected) + std::pow(J.norm(), 2.0)));
    }
  }
}

// On the orbit of even eta both multipliers are gamma, over half a tau.
TEST(HammerJacobian, ExponentsAtEvenEtaAreThoseOfTheRestitution) {
  const LyapunovSpectrum s = lyapunov(hammer(0.7, 0.05), 4.0, start_at(4.0));
  EXPECT_NEAR(s.exponents[0], 2.0 * std::log(0.7), 1e-6);
  EXPECT_NEAR(s.exponents[1], 2.0 * std::log(0.7), 1e-6);
}

// In contact the hammer has no freedom left.
TEST(HammerJacobian, AfterContactNothingIsLeft) {
  const LyapunovSpectrum s = lyapunov(hammer(0.7, 1.4), 7.0, start_at(7.0));
  ASSERT_EQ(s.outcome, LyapunovOutcome::measured);
  EXPECT_EQ(s.rank, 0);
  EXPECT_EQ(s.exponents[0], -INFINITY);
  EXPECT_EQ(s.volume_rate, -INFINITY);
}

}  // namespace
}  // namespace afm
