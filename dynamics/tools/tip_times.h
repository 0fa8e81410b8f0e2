// The time that it takes to compute tips, for tools that compare levels of the model.
#pragma once

#include <vector>

#include "afm/tip.h"

namespace afm {

// Processor time of a tau [ns] of each tip: the median of intervals that the tips fly by turns, so that what else the
// machine does meets them alike. Each has an interval of its own: where tips make the same chaotic flights, the first
// would pay a sixth more, as the processor has learned the branches when the others make them. Infinite where a tip
// does not get on.
std::vector<double> nanoseconds_per_tau(std::vector<Tip> tips);

}  // namespace afm
