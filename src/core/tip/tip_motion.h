// Energy and counts along a slide.
#pragma once

#include <cmath>
#include <cstdint>

#include "afm/contact.h"

namespace afm {

// Kinetic energy and that of the springs [m a^2/tau^2].
double slide_energy(const Mechanics<double>& m, const SlideState<double>& q);

// Of x - xc over the first s [a tau].
double extension_integral(const SlideSegment<double>& slide, double s);

// What the bounces of a chatter sequence have lost: the fall of v^2/2 from `first`, its first normal speed, and `gain`.
inline double chatter_loss(double first, double v, double gain) { return 0.5 * (first - v) * (first + v) + gain; }

// The count of a chatter sequence that has ended: at least its first bounce.
inline std::uint32_t whole_count(double n) {
  return static_cast<std::uint32_t>(std::fmax(1.0, std::fmin(std::floor(n), 4294967295.0)));
}

}  // namespace afm
