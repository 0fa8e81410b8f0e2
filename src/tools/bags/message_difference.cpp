#include "message_difference.h"

#include <algorithm>
#include <cstddef>
#include <vector>

namespace afm::bags {
namespace {

struct Field {
  std::string path, value;  // "impacts[3].time.phase"

  bool is_element() const { return !path.empty() && path.back() == ']'; }
};

// ROS prints a field a line, "    phase: 0.5", deeper than what it lies in. An array has a heading, "impacts[]", and
// below it "impacts[0]: ".
std::vector<Field> fields_of(const std::string& text) {
  struct Outer {
    std::size_t depth;
    std::string path;
  };
  std::vector<Field> fields;
  std::vector<Outer> outer{{0, ""}};
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) {
    const std::size_t depth = line.find_first_not_of(' '), colon = line.find(": ");
    if (depth == std::string::npos) continue;
    while (outer.size() > 1 && outer.back().depth >= depth) outer.pop_back();
    const bool is_heading = colon == std::string::npos && line.substr(line.size() - 2) == "[]";
    const std::string key = line.substr(depth, colon - depth), before = outer.back().path;
    const std::string path = is_heading ? before : before + (before.empty() ? "" : ".") + key;
    if (!is_heading) fields.push_back({path, colon == std::string::npos ? "" : line.substr(colon + 2)});
    outer.push_back({depth, path});
  }
  return fields;
}

}  // namespace

FieldDifference first_difference(const std::string& recorded, const std::string& simulated) {
  const std::vector<Field> a = fields_of(recorded), b = fields_of(simulated);
  for (std::size_t i = 0; i < std::max(a.size(), b.size()); ++i) {
    const bool both = i < a.size() && i < b.size() && a[i].path == b[i].path;
    if (both && a[i].value == b[i].value) continue;
    if (both) return {a[i].path, a[i].value, b[i].value};
    // an array of one ends first
    const bool is_longer = i < a.size() && (i >= b.size() || a[i].is_element());
    return is_longer ? FieldDifference{a[i].path, a[i].value, "none"} : FieldDifference{b[i].path, "none", b[i].value};
  }
  return {"bytes", "differ", "differ"};
}

}  // namespace afm::bags
