// The level of the model that a command or a change of parameters brought, as a message reports it: plain values.
#pragma once

#include <limits>

#include "afm/level.h"

namespace afm::node {

struct AppliedLevel {
  Level level;
  double expected_error = std::numeric_limits<double>::quiet_NaN();  // NaN: not known, or not asked for
  double energy_dropped = 0.0;                                       // on the way to it [m a^2/tau^2]
};

}  // namespace afm::node
