// Collects the faults of a set of parameters. A limit stands in one place: the text of a fault is made from it. A set
// without faults allocates nothing.
#pragma once

#include <string>
#include <vector>

#include "afm/model.h"
#include "afm/number_text.h"

namespace afm::detail {

struct FaultList {
  std::vector<ParameterError> faults;

  // `holds` is false for NaN.
  void require(bool holds, const char* name, double value, const char* reason) {
    if (!holds) faults.emplace_back(name, value, reason);
  }
  // `reason` is followed by the limits and `unit`.
  void require_between(double least, double most, const char* name, double value, const char* reason,
                       const char* unit = "") {
    if (value >= least && value <= most) return;
    faults.emplace_back(name, value,
                        std::string(reason) + " between " + number_text(least) + " and " + number_text(most) + unit);
  }
};

}  // namespace afm::detail
