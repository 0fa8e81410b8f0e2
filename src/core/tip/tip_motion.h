// Energy and counts along a slide.
#pragma once

#include <cmath>
#include <cstdint>

#include "afm/detail/chatter.h"

namespace afm::detail {

// Kinetic energy and that of the springs [m_tip a^2/tau^2].
double slide_energy(const SpringConstants<double>& m, const SlideState<double>& q);

// The time integral of x - xc over the first s [a tau].
double extension_integral(const SlideSegment<double>& slide, double s);

// A tip that bounces along a slide with the normal speed v.
struct BouncingSlide {
  SlideState<double> slide;
  double v;
};
// The state of the energy `energy` nearest to `at`. If none is near, a state of another energy.
BouncingSlide with_energy(const SpringConstants<double>& m, const BouncingSlide& at, double energy);

// Chatter that has died: the rest of its normal speed is lost.
inline Chatter settled(Chatter chatter) {
  chatter.loss += 0.5 * chatter.v * chatter.v;
  chatter.v = 0.0;
  return chatter;
}

// The count of a chatter sequence under way. It stays at the largest that an event can have.
inline std::uint32_t count_so_far(double n) { return static_cast<std::uint32_t>(std::fmin(n, 4294967295.0)); }

// That of one that has ended: at least its first bounce.
inline std::uint32_t whole_count(double n) { return count_so_far(std::fmax(1.0, n)); }

}  // namespace afm::detail
