#include "afm/dynamics/jacobian.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>

#include "afm/landing.h"
#include "afm/reflection.h"
#include "support/models.h"
#include "support/quad_impacts.h"
#include "trials/random_launches.h"

namespace afm {
namespace {

// above, around and below the cutoff; with the fold of the law (gamma < 1/2); elastic
const Model kModels[] = {model_with(0.7, 0.0), model_with(0.7, 0.5), model_with(0.7, 20.0), model_with(0.3, 5.0),
                         model_with(1.0, 0.05)};

// One random flight with the impact that ends it.
struct Bounce {
  double eta;
  TipState start;
  Flight<double> flight;
  Landing<double> landing;
  SectionJacobian<double> J;
  TipState after;
};

class Bounces {
 public:
  Bounces(const Model& model, unsigned seed) : model_(model), launches_(seed) {}

  Bounce next() {
    for (;;) {
      const double eta = launches_.within(-9.0, 9.0);
      TipState start = launches_.next(eta, -4.0, 1.0);
      if (model_.kind == ModelKind::hammer) start.X = 0.0, start.u = eta;
      const Flight<double> flight(SpringConstants<double>(model_), eta, start);
      const Landing<double> landing = find_landing(model_, flight, 8.0);
      if (landing.outcome != SearchOutcome::impact) continue;
      return {eta,
              start,
              flight,
              landing,
              section_jacobian(model_, flight, landing.s, landing.jet),
              reflect(model_, eta, landing.jet).after};
    }
  }

 private:
  Model model_;
  RandomLaunches launches_;
};

constexpr int kImpacts = 2000;  // of each model: 1e4 in all
const Quad kStep(1e-13);

void expect_derivative(const Model& model) {
  Bounces bounces(model, 1);
  int below_cutoff = 0;
  for (int i = 0; i < kImpacts; ++i) {
    const Bounce b = bounces.next();
    QuadImpacts exact(model, b.eta);
    const auto map = [&](const QuadPoint& p) { return exact.next(p, b.landing.s); };
    const Eigen::Matrix4d truth = quad_differences<4>(map, quad_point(b.start), kStep);
    below_cutoff += exact.speed() < model.v_c ? 1 : 0;
    ASSERT_LE(relative_distance(b.J, truth), 1e-9) << "impact " << i << ", normal speed " << exact.speed();
    if (model.kind == ModelKind::oscillator) continue;
    ASSERT_EQ(b.J.row(1).norm() + b.J.row(2).norm(), 0.0);
    ASSERT_EQ(b.after.X, 0.0);
    ASSERT_EQ(b.after.u, b.eta);
  }
  const int expected = model.v_c >= 0.5 ? kImpacts / 20 : 0;
  EXPECT_GE(below_cutoff, expected) << "v_c " << model.v_c;
}

TEST(SectionJacobian, IsTheDerivativeOfTheMap) {
  for (const Model& model : kModels) expect_derivative(model);
}
TEST(SectionJacobian, OfTheHammerToo) {
  for (const Model& model : kModels) expect_derivative(hammer(model.gamma, model.v_c));
}

// Eq. 2: the projection along the flow F onto the surface with the gradient G.
FlowJacobian<double> onto_surface(const FlowVector<double>& F, const FlowVector<double>& G) {
  return FlowJacobian<double>::Identity() - F * (G.transpose() / G.dot(F));
}

// Eq. 5: the Jacobian of a map in a flow: onto the surface, through the map, back to one time in the flow after it.
FlowJacobian<double> map_in_flow(const FlowVector<double>& before, const FlowVector<double>& after,
                                 const FlowVector<double>& G, const FlowJacobian<double>& map) {
  return map * onto_surface(before, G) + after * (G.transpose() / G.dot(before));
}

// Eq. 13-16 with corrected signs and with the slope of the law, in the frame of tangent and normal at the impact,
// positions before velocities. A_n is the normal acceleration. The determinant is restitution * slope. For the
// oscillator.
Eigen::Matrix4d local_reflection_jacobian(const Model& model, const Incidence<double>& in, double A_n) {
  const double N2 = 1.0 + in.surface.h1 * in.surface.h1, k = in.surface.h2 / (N2 * std::sqrt(N2));
  const double v_n = -in.normal_speed, v_t = in.tangential_velocity;
  const RestitutionJet<double> law = restitution_jet(model, in.normal_speed);
  const double kick = 1.0 + law.restitution, gain = 1.0 + law.slope;
  Eigen::Matrix4d J;
  J << 1.0, 0.0, 0.0, 0.0,                        //
      0.0, -law.restitution, 0.0, 0.0,            //
      kick * k * v_n, -kick * k * v_t, 1.0, 0.0,  //
      gain * k * v_t, gain * (A_n - k * v_t * v_t) / v_n, 0.0, -law.slope;
  return J;
}

// The whole impact in the flow: Eq. 5, and turned into the frame of Eq. 13.
Eigen::Matrix4d general_reflection(const Model& model, const Bounce& b, const Incidence<double>& in) {
  const SpringConstants<double>& m = b.flight.springs();
  const FlightState<double>& q = b.landing.jet.state;
  FlightState<double> after = q;
  after.U = b.after.u - b.eta;
  after.W = b.after.g1 + in.surface.h1 * b.after.u;
  const FlowJacobian<double> J = map_in_flow(flight_velocity(m, b.eta, q), flight_velocity(m, b.eta, after),
                                             gap_gradient(in.surface), reflection_derivative(model, in));
  const double N = std::sqrt(1.0 + in.surface.h1 * in.surface.h1), tx = 1.0 / N, ty = in.surface.h1 / N;
  Eigen::Matrix<double, 4, 5> turn = Eigen::Matrix<double, 4, 5>::Zero();
  turn(0, 0) = turn(1, 3) = turn(2, 2) = turn(3, 4) = tx;
  turn(0, 3) = turn(2, 4) = ty;
  turn(1, 0) = turn(3, 2) = -ty;
  return turn * J * turn.transpose();
}

TEST(ReflectionJacobian, OfThePaperIsThatOfTheGeneralConstruction) {
  for (const Model& model : kModels) {
    Bounces bounces(model, 3);
    for (int i = 0; i < kImpacts; ++i) {
      const Bounce b = bounces.next();
      const SpringConstants<double>& m = b.flight.springs();
      const Incidence<double> in(m, b.eta, b.landing.jet.state, b.landing.jet.g1);
      const double h1 = in.surface.h1, N = std::sqrt(1.0 + h1 * h1);
      const FlowVector<double> F = flight_velocity(m, b.eta, b.landing.jet.state);
      const Eigen::Matrix4d J = local_reflection_jacobian(model, in, (F(4) - h1 * F(2)) / N);
      ASSERT_LE(relative_distance(general_reflection(model, b, in), J), 1e-10);
      const RestitutionJet<double> law = restitution_jet(model, in.normal_speed);
      ASSERT_NEAR(J.determinant(), law.restitution * law.slope, 1e-12);
    }
  }
}

}  // namespace
}  // namespace afm
