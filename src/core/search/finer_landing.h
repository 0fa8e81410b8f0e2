// The impact search where the rounding of a double hides the root.
#pragma once

#include "afm/landing.h"

namespace afm::detail {

// find_landing in double-double numbers, from `from` on [tau]; rounded to double. The outcome may be `undecided`.
// Precondition: no impact before `from`.
Landing<double> find_finer_landing(const Model& model, const Flight<double>& flight, double horizon, double from);

}  // namespace afm::detail
