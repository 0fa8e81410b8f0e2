// Where a polynomial in Bernstein's basis first falls to zero.
#pragma once

#include "afm/detail/contact_step.h"

namespace afm::detail {

// The first zero of the polynomial with the coefficients b over [low, low + width]; negative if there is none. The
// interval is halved, at most so many times, until the first change of sign is near the zero: within 1/8 of the last
// part.
double first_fall(const AtGaussNodes& b, double low, double width, int halvings);

}  // namespace afm::detail
