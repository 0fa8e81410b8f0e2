// Where two messages differ, as ROS prints them: nothing here lists the fields of a message.
#pragma once

#include <algorithm>
#include <cstddef>
#include <limits>
#include <sstream>
#include <string>
#include <vector>

namespace afm::bags {

struct FieldDifference {
  std::string field;                // with those that it lies in: impacts[3].time.phase
  std::string recorded, simulated;  // of numbers: 17 digits
};

struct Field {
  std::string path, value;
};

// ROS prints a field a line, "    phase: 0.5", deeper than what it lies in. An array has a heading, "impacts[]", and
// below it "impacts[0]: ".
template <class Message>
std::vector<Field> printed_fields(const Message& message) {
  struct Outer {
    std::size_t depth;
    std::string path;
  };
  std::vector<Field> fields;
  std::vector<Outer> outer{{0, ""}};
  std::stringstream text;
  text.precision(std::numeric_limits<double>::max_digits10);
  text << message;
  for (std::string line; std::getline(text, line);) {
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

// Where both print alike (the signs of two NaN), the field is "bytes".
template <class Message>
FieldDifference find_difference(const Message& recorded, const Message& simulated) {
  const std::vector<Field> a = printed_fields(recorded), b = printed_fields(simulated);
  for (std::size_t i = 0; i < std::max(a.size(), b.size()); ++i) {
    const bool both = i < a.size() && i < b.size() && a[i].path == b[i].path;
    if (both && a[i].value == b[i].value) continue;
    if (both) return {a[i].path, a[i].value, b[i].value};
    // an array of one has more elements
    if (a.size() > b.size()) return {a[i].path, a[i].value, "none"};
    return {b[i].path, "none", b[i].value};
  }
  return {"bytes", "differ", "differ"};
}

}  // namespace afm::bags
