#include "tip_motion.h"

#include "afm/surface.h"

namespace afm {

double slide_energy(const Mechanics<double>& m, const SlideState<double>& q) {
  const SurfaceJet<double> surface = surface_jet(m.H, q.phase);
  const double Y = surface.h - m.y0;
  return 0.5 * ((1.0 + surface.h1 * surface.h1) * q.u * q.u + m.omega_h * m.omega_h * q.X * q.X +
                m.omega_v * m.omega_v * Y * Y);
}

double extension_integral(const SlideSegment<double>& slide, double s) {
  return s * (slide.start().X - 0.5 * slide.eta() * s) + slide.displacement_integral(s);
}

}  // namespace afm
