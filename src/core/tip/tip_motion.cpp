#include "tip_motion.h"

#include <cmath>

#include "afm/surface.h"

namespace afm::detail {

double slide_energy(const SpringConstants<double>& m, const SlideState<double>& q) {
  const SurfaceJet<double> surface = surface_jet(m.H, q.phase);
  const double Y = surface.h - m.y0;
  return 0.5 * ((1.0 + surface.h1 * surface.h1) * q.u * q.u + m.omega_h * m.omega_h * q.X * q.X +
                m.omega_v * m.omega_v * Y * Y);
}

// By steps along the gradient, in the coordinates x omega_h, speed along the surface, normal speed. Nearly at rest the
// energy is quadratic in them, so one step may take most of it. There x counts with the stiffness that the load adds.
BouncingSlide with_energy(const SpringConstants<double>& m, const BouncingSlide& at, double energy) {
  constexpr int kSteps = 3;  // each squares the relative error, which is 1e-4 but for a tip nearly at rest
  // of the square of the gradient, which is twice the energy of motion
  constexpr double kLinear = 0.1;      // a smaller change is linear
  constexpr double kMostTaken = 0.45;  // one half would be all
  constexpr double kMostGiven = 1.0;   // a choice: more is no correction
  SlideState<double> r = at.slide;
  double v = at.v;
  for (int i = 0; i < kSteps; ++i) {
    const SurfaceJet<double> h = surface_jet(m.H, r.phase);
    const double Y = h.h - m.y0, slope2 = 1.0 + h.h1 * h.h1;
    const double speed2 = slope2 * r.u * r.u, wh2 = m.omega_h * m.omega_h, wv2 = m.omega_v * m.omega_v;
    const double force = wh2 * r.X + wv2 * Y * h.h1 + h.h1 * h.h2 * r.u * r.u;  // dE/dx
    const double left = energy - 0.5 * (speed2 + wh2 * r.X * r.X + wv2 * Y * Y + v * v);
    double stiffness = wh2, part = left / (speed2 + force * force / wh2 + v * v);
    if (!(std::fabs(part) < kLinear)) {
      stiffness = std::fmax(wh2, wh2 + wv2 * (Y * h.h2 + h.h1 * h.h1));
      const double ratio = left / (speed2 + force * force / stiffness + v * v);
      if (!(-kMostTaken < ratio && ratio < kMostGiven)) break;
      part = std::sqrt(1.0 + 2.0 * ratio) - 1.0;
    }
    const double dx = part * force / stiffness;
    r.phase += dx, r.X += dx, r.u += part * r.u, v += part * v;
  }
  return {r, v};
}

double extension_integral(const SlideSegment<double>& slide, double s) {
  return s * (slide.start().X - 0.5 * slide.eta() * s) + slide.displacement_integral(s);
}

}  // namespace afm::detail
