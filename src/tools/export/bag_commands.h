// The commands of a recording in the order in which they took effect, each with everything that is in force from there on.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "afm/state.h"
#include "node/parameters/live_parameters.h"
#include "tools/replay/recording.h"

namespace afm {

struct CommandRow {
  std::uint32_t epoch = 0;
  ModelTime time;              // from which the rest holds
  double drag_velocity = 0.0;  // [m/s]; NaN if the recording does not contain it
  node::LiveParameters live;
  std::string model;
  double contact_tolerance = 0.0;
  std::uint64_t first_impact = 0;  // index of the first impact after it
};

// A row for every moment at which commands took effect: the beginning of every epoch is the first.
std::vector<CommandRow> commands_of(const replay::Recording& recording);

}  // namespace afm
