// What is said of a run before it begins, so that nobody learns it from wrong numbers.
#pragma once

#include <string>
#include <vector>

#include "node/params/parameters.h"

namespace afm::node {

// The tip in the terms of its owner.
std::string describe_tip(const Parameters& parameters);

// What makes a run other than its owner expects: kicks that lock to the lateral spring, heat without damping, and a
// time-out of commands in lockstep.
std::vector<std::string> find_traps(const Parameters& parameters);

// The run that a trial goes on with. Undamped, a tip that has slipped swings for good, and a slow drag may take seconds
// to its first slip: where the tip sticks and slips, it was dragged over a slip first.
Run trial_run(const Parameters& parameters);

// Model time per processor time of the run alone, without what it costs to publish, from a trial run of some
// milliseconds.
double measure_pace(const Parameters& parameters);

// What to change where a trial run made too few times real time (`pace`); nothing where it made enough.
std::string find_pace_fault(const Parameters& parameters, double pace);

}  // namespace afm::node
