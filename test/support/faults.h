// Which parameters are at fault.
#pragma once

#include <set>
#include <string>
#include <vector>

#include "afm/model.h"

namespace afm {

inline std::multiset<std::string> names(const std::vector<ParameterError>& faults) {
  std::multiset<std::string> result;
  for (const ParameterError& fault : faults) result.insert(fault.name);
  return result;
}

}  // namespace afm
