// Where Bernstein's coefficients of a polynomial, which enclose it, first fall to zero. In a file of its own, without
// vectors: each element would wait for its neighbour.
#pragma once

#include "afm/detail/contact_step.h"

namespace afm::detail {

// Over [low, low + width], with the coefficients b, after so many halvings: within the last part in which they fall. No
// fall of the polynomial is passed; one that comes near may count. Negative: they do not fall.
double first_bernstein_fall(const AtGaussNodes& b, double low, double width, int halvings);

}  // namespace afm::detail
