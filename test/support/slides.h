// Slides for tests: random ones, and what their pressure should be.
#pragma once

#include "afm/detail/slide_segment.h"
#include "afm/surface.h"
#include "core/contact/slide_release.h"
#include "trials/random_launches.h"

namespace afm {

using SlidePart = detail::SlideSegment<double>;

// Minus what the gap's acceleration would be in free flight, over 1 + h'^2.
template <class T>
T pressure_of(const Model& model, const detail::SlideState<T>& s) {
  const SpringConstants<T> m(model);
  const SurfaceJet<T> h = surface_jet(m.H, s.phase);
  return (m.omega_v * m.omega_v * (h.h - m.y0) + h.h2 * s.u * s.u - h.h1 * m.omega_h * m.omega_h * s.X) /
         (T(1.0) + h.h1 * h.h1);
}

// Along the surface and in the springs.
inline double energy_of(const SpringConstants<double>& m, const detail::SlideState<double>& s) {
  const SurfaceJet<double> h = surface_jet(m.H, s.phase);
  const double Y = m.omega_v * (h.h - m.y0), X = m.omega_h * s.X;
  return 0.5 * (s.u * s.u * (1.0 + h.h1 * h.h1) + X * X + Y * Y);
}

// Of the reaction over time.
inline double pressure_slope(const SlidePart& part, double s) {
  double slope = 0.0;
  for (std::size_t k = detail::kSlideOrder; k >= 1; --k) {
    slope = slope * s + static_cast<double>(k) * part.reaction()[k];
  }
  return slope;
}

inline double end_of(const SlidePart& part) {
  const double release = detail::find_release(part);
  return release < 0.0 ? part.length() : release;
}

// Pressed, and moving about as fast as it is dragged.
inline SlidePart random_part(double eta, RandomLaunches& random) {
  for (;;) {
    const double u = eta * random.within(0.5, 1.5);
    const SlidePart part(SpringConstants<double>(Model()), eta,
                         {random.within(0.0, 1.0), random.within(-0.02, 0.02), u});
    if (part.pressure(0.0) > 0.01) return part;
  }
}
inline SlidePart random_part(RandomLaunches& random) { return random_part(random.within(-9.0, 9.0), random); }

}  // namespace afm
