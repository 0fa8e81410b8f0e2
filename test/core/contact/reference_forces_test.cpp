// The reaction and its coefficients against differences in quad precision, along the surface and in time.
#include "core/contact/reference_forces.h"

#include <gtest/gtest.h>

#include "support/slides.h"
#include "trials/quad.h"

namespace afm {

using namespace detail;

namespace {

using State = SlideState<Quad>;

Quad slope(const Model& model, const State& q) { return surface_jet(Quad(model.H), q.phase).h1; }
Quad length_per_x(const Model& model, const State& q) {
  const Quad s = slope(model, q);
  return sqrt(1 + s * s);
}

Quad reaction(const Model& model, const State& q) { return pressure_of(model, q) * length_per_x(model, q); }

// Of the springs alone.
Quad tangential_force(const Model& model, const State& q) {
  const SpringConstants<Quad> m(model);
  const Quad s = slope(model, q), y = surface_jet(m.H, q.phase).h - m.y0;
  return -(m.omega_h * m.omega_h * q.X + s * m.omega_v * m.omega_v * y) / length_per_x(model, q);
}

// So far along the surface, at the same speed.
State moved(const Model& model, const State& q, const Quad& along) {
  const Quad N = length_per_x(model, q), dx = along / N;
  const State there{q.phase + dx, q.X + dx, q.u};
  return {there.phase, there.X, q.u * N / length_per_x(model, there)};
}

TEST(ReferenceForces, TheirCoefficientsAreDerivativesAlongTheSurfaceAndInTime) {
  const Quad step = 1e-8;
  RandomLaunches random(1);
  for (int i = 0; i < 200; ++i) {
    Model model;
    model.H = random.within(0.05, 0.5);
    const double eta = random.within(-5.0, 5.0);
    const SlideState<double> q{random.within(0.0, 1.0), random.within(-0.02, 0.02), eta + random.within(-2.0, 2.0)};
    const ReferenceForces<double> f = reference_forces(SpringConstants<double>(model), eta, q);
    const auto expect = [&](double found, const Quad& derivative, double scale) {
      const double d = static_cast<double>(derivative);
      EXPECT_NEAR(found, d, 1e-9 * (std::abs(d) + scale)) << i;
    };
    const State here{q.phase, q.X, q.u}, back = moved(model, here, -step), ahead = moved(model, here, step);
    expect(f.c_height, (reaction(model, back) - reaction(model, ahead)) / (2 * step), 1e3);
    expect(f.c_sigma, (tangential_force(model, back) - tangential_force(model, ahead)) / (2 * step), 1e3);
    const SlideSegment<Quad> slide(SpringConstants<Quad>(model), Quad(eta), here);
    const Quad before = reaction(model, slide.at(-step)), after = reaction(model, slide.at(step));
    expect(f.P, reaction(model, here), 1.0);
    expect(f.P1, (after - before) / (2 * step), 1e3);
    expect(f.P2, (after - 2 * reaction(model, here) + before) / (step * step), 1e3);
  }
}

}  // namespace
}  // namespace afm
