// One point of a friction curve on its attractor. Natural units.
#pragma once

#include "afm/sweep.h"

namespace afm {

// Finds the attractor of the start and averages over its periods; where it is not periodic, and with a bath, over time.
// Guarantee: a function of its arguments, to the last bit. Precondition: no faults.
SweepResult sweep_attractor(const SweepPoint& point, const SweepSettings& settings, const TipState& start);

}  // namespace afm
