// A whole curve or map by threads, into a file that an interrupted run goes on with.
#pragma once

#include <string>

#include "common/table_units.h"
#include "grid.h"

namespace afm {

// Returns the exit code: 0, 1 where a file cannot be written, 2 where the output cannot be taken for this run, 130 when
// interrupted. Faults go to stderr. `output` "-" is standard output, and then there is nothing to go on with.
int run_curve(const CurveSettings& settings, const std::string& output, int threads,
              const TableUnits& units = TableUnits::plain());

}  // namespace afm
