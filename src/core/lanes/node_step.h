// A burst's step with its four nodes in the lanes of one register. No code of its own: it is shared by files that are
// compiled for different machines.
#pragma once

#include "afm/detail/chatter_rates.h"

namespace afm {
namespace lanes {

// On the machine this runs on; null where it has no lanes.
NodeStep node_step();

void node_step_avx2(const ChatterFlow& flow, const ChatterPlace& from, double dt, ChatterPlace& to);

}  // namespace lanes
}  // namespace afm
