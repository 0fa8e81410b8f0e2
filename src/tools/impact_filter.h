// next_impact without its command line: a table of states after an impact in, the same with the next impact out.
#pragma once

#include <istream>
#include <ostream>
#include <string>
#include <vector>

#include "afm/single_flight.h"
#include "common/table_units.h"

namespace afm {

extern const std::vector<Column> kImpactColumns;  // the inputs, then the outputs

// The header that a table must have, and that of what comes out.
std::string impact_input_header(const TableUnits& units = TableUnits::plain());
std::string impact_output_header(const TableUnits& units = TableUnits::plain());

// A row for each of the table's, without the header, both in these units; nan where one cannot be computed, reported as
// name:LINE in `complaints`. Whether every row could be computed. `tip`: what no column says.
bool filter_impacts(const FlightInput& tip, std::istream& in, const std::string& name, std::ostream& out,
                    std::ostream& complaints, const TableUnits& units = TableUnits::plain());

}  // namespace afm
