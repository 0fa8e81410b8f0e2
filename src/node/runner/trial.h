// What pace a run will reach, before it begins.
#pragma once

#include "node/params/parameters.h"

namespace afm::node {

// Model time per wall time of the run alone, without what it costs to publish, from a trial run of some milliseconds.
double measure_pace(const Parameters& parameters);

}  // namespace afm::node
