// The smallest force that counts as a release of the tip from the surface.
#pragma once

#include <algorithm>
#include <cmath>

#include "afm/spring_constants.h"

namespace afm::detail {

// The smallest pull that counts as a release [a/tau^2]; a smaller one is rounding. Without it the glide at eta = 1,
// whose reaction is zero for ever, would be released and caught at every rounding. A release waits until the pull has
// grown to it: 1e-11 tau where the reaction falls by 100 a/tau^2 in a tau, 2e-8 tau where it falls slowly. If the terms
// of the reaction exceed 1e4, as with mica's springs above 50 a/tau, it is a part of them.
constexpr double kReleaseNoise = 1e-9;

inline double release_noise(const SpringConstants<double>& m, double u, double X) {
  constexpr double kRelativeNoise = 1e-13;  // of the terms: each sum of a slide's series has an error of 3e-14
  const double k = m.omega_v, turning = k * k * m.H * (1.0 + u * u), rest = k * k * std::abs(m.y0);
  return std::max(kReleaseNoise, kRelativeNoise * (turning + rest + k * m.H * (m.omega_h * m.omega_h) * std::abs(X)));
}

}  // namespace afm::detail
