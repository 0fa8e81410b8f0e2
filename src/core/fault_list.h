// The faults of a set of parameters: how they are collected, and by which word a user knows the parameter.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "afm/model.h"
#include "afm/number_text.h"

namespace afm::detail {

// The word of tables, options and arguments for a member of Model or of RunSettings: cutoff for v_c.
inline std::string word_for(const std::string& member) {
  static const std::map<std::string, std::string> words{{"v_c", "cutoff"},
                                                        {"y0", "rest_height"},
                                                        {"H", "amplitude"},
                                                        {"initial_phase", "phase"},
                                                        {"initial_extension", "extension"},
                                                        {"initial_height", "y"},
                                                        {"initial_u", "u"},
                                                        {"initial_w", "w"}};
  const auto found = words.find(member);
  return found == words.end() ? member : found->second;
}

// A limit stands in one place: the text of a fault is made from it. A set without faults allocates nothing.
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
