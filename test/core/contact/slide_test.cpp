// The slide against its equation of motion integrated in quad precision.
#include <gtest/gtest.h>

#include <array>
#include <boost/math/quadrature/gauss.hpp>
#include <boost/numeric/odeint/stepper/runge_kutta_fehlberg78.hpp>
#include <cmath>
#include <vector>

#include "afm/detail/slide_segment.h"
#include "support/slides.h"
#include "trials/quad.h"

namespace afm {

using namespace detail;

namespace {

const Model kMica;
const SpringConstants<double> kSpringConstants(kMica);

using Motion = std::array<Quad, 3>;  // phase, X, u

// Lagrange's equation of a bead on the wire y = h(x).
struct Bead {
  Quad eta;

  void operator()(const Motion& q, Motion& rate, const Quad& /*t*/) const {
    static const SpringConstants<Quad> m(kMica);
    const SurfaceJet<Quad> h = surface_jet(m.H, q[0]);
    const Quad force = -m.omega_h * m.omega_h * q[1] - m.omega_v * m.omega_v * (h.h - m.y0) * h.h1;
    rate = {q[2], q[2] - eta, (force - h.h1 * h.h2 * q[2] * q[2]) / (1 + h.h1 * h.h1)};
  }
};

class QuadSlide {
 public:
  QuadSlide(double eta, const SlideState<double>& start) : bead_{eta}, q_{start.phase, start.X, start.u} {}

  // in steps that leave errors below 1e-16
  void advance(double dt) {
    const int steps = static_cast<int>(std::ceil(400.0 * (2.0 + std::abs(static_cast<double>(bead_.eta))) * dt));
    for (int i = 0; i < steps; ++i) stepper_.do_step(bead_, q_, Quad(0), Quad(dt) / steps);
  }
  SlideState<Quad> state() const { return {q_[0], q_[1], q_[2]}; }

 private:
  Bead bead_;
  Motion q_;
  boost::numeric::odeint::runge_kutta_fehlberg78<Motion, Quad> stepper_;
};

// The whole slide, part by part, up to its release.
std::vector<SlidePart> parts_of(double eta, const SlideState<double>& start) {
  constexpr std::size_t kMost = 1000;
  std::vector<SlidePart> parts{SlidePart(kSpringConstants, eta, start)};
  while (find_release(parts.back()) < 0.0 && parts.size() < kMost) {
    parts.emplace_back(kSpringConstants, eta, parts.back().at(parts.back().length()));
  }
  return parts;
}

double difference(double a, const Quad& b) { return static_cast<double>(abs(a - b)); }

class Slide : public testing::TestWithParam<double> {};

TEST(Slide, TheIntegralOfItsDisplacementIsThat) {
  RandomLaunches random(7);
  for (int i = 0; i < 200; ++i) {
    const SlidePart part = random_part(random);
    const auto d = [&](double s) { return part.at(s).phase - part.start().phase; };
    const double s = random.within(0.1, 1.0) * part.length();
    const double sum = boost::math::quadrature::gauss<double, 10>::integrate(d, 0.0, s);  // exact for these powers
    EXPECT_NEAR(part.displacement_integral(s), sum, 3e-16 * s);
  }
}

TEST_P(Slide, IsTheSolutionOfItsEquationOfMotion) {
  RandomLaunches random(1);
  for (int episode = 0; episode < 20; ++episode) {
    const SlideState<double> start = random_part(GetParam(), random).start();
    QuadSlide truth(GetParam(), start);
    for (const SlidePart& part : parts_of(GetParam(), start)) {
      const double middle = 0.5 * end_of(part);
      for (const double s : {middle, 2.0 * middle}) {
        truth.advance(middle);
        ASSERT_LT(difference(part.at(s).phase, truth.state().phase), 1e-12);
        ASSERT_LT(difference(part.at(s).X, truth.state().X), 1e-12);
        ASSERT_LT(difference(part.at(s).u, truth.state().u), 1e-12);
      }
    }
    // let go where the true pressure has fallen to nothing
    ASSERT_LT(difference(-kReleaseNoise, pressure_of(kMica, truth.state())), 1e-10);
  }
}

// Its length is chosen by its last two terms.
TEST(Slide, APieceIsGoodUpToItsLengthAndNotFarBeyond) {
  RandomLaunches random(3);
  for (int i = 0; i < 60; ++i) {
    const SlidePart part = random_part(random);
    QuadSlide truth(part.eta(), part.start());
    truth.advance(part.length());
    ASSERT_LT(difference(part.at(part.length()).u, truth.state().u), 1e-14);
    truth.advance(part.length());
    ASSERT_GT(difference(part.at(2.0 * part.length()).u, truth.state().u), 1e-12) << "shorter than it need be";
  }
}

INSTANTIATE_TEST_SUITE_P(DragSpeeds, Slide, testing::Values(0.2, 0.5, -0.5, 3.0, 5.0, 9.0));

}  // namespace
}  // namespace afm
