// What is said of a run before it begins, so that nobody learns it from wrong numbers.
#pragma once

#include <string>
#include <vector>

#include "node/params/parameters.h"

namespace afm::node {

// The tip in the terms of its owner.
std::string describe_tip(const Parameters& parameters);

// Warnings of what the owner may not expect: kicks that lock or are too few, heat without damping, samples at few
// phases of tau, a tolerance without model auto, and in lockstep a time-out of commands or a split recording.
std::vector<std::string> find_warnings(const Parameters& parameters);

// The run that a trial goes on with. Undamped, a tip that has slipped swings for good, and a slow drag may take seconds
// to its first slip: where the tip sticks and slips, it was dragged over a slip first.
Run trial_run(const Parameters& parameters);

// Model time per processor time of the run alone, without what it costs to publish, from a trial run of some
// milliseconds.
double measure_times_real_time(const Parameters& parameters);

// The remedy, if a trial run made too few times real time; else empty.
std::string find_speed_warning(const Parameters& parameters, double times_real_time);

}  // namespace afm::node
