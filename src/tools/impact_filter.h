// next_impact without its command line: a table of states after an impact in, the same with the next impact out.
#pragma once

#include <istream>
#include <ostream>
#include <string>

#include "afm/model.h"

namespace afm {

extern const std::string kImpactInputHeader, kImpactOutputHeader;

// A row for each of the table's, without the header; nan where one cannot be computed, told as name:LINE in
// `complaints`. Whether every row could be computed.
bool filter_impacts(ModelKind kind, std::istream& in, const std::string& name, std::ostream& out,
                    std::ostream& complaints);

}  // namespace afm
