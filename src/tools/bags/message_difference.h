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

// ROS prints a field a line, "    phase: 0.5", deeper than what it lies in. An array has a heading, "impacts[]", and
// below it "impacts[0]: ".
template <class Message>
std::vector<std::string> printed_lines(const Message& message) {
  std::stringstream text;
  text.precision(std::numeric_limits<double>::max_digits10);
  text << message;
  std::vector<std::string> lines;
  for (std::string line; std::getline(text, line);) {
    if (line.find_first_not_of(' ') != std::string::npos) lines.push_back(line);
  }
  return lines;
}

// The field of a line: those that it lies in are above it, each deeper than the one before.
inline std::string field_of(const std::vector<std::string>& lines, std::size_t at) {
  std::string path;
  std::size_t depth = std::string::npos;
  for (std::size_t i = at + 1; i-- > 0;) {
    const std::size_t own = lines[i].find_first_not_of(' ');
    if (own >= depth) continue;
    depth = own;
    if (lines[i].find(':') == std::string::npos) continue;  // a heading
    path = lines[i].substr(own, lines[i].find(':') - own) + (path.empty() ? "" : "." + path);
  }
  return path;
}

inline std::string value_of(const std::string& line) {
  const std::size_t colon = line.find(": ");
  return colon == std::string::npos ? "" : line.substr(colon + 2);
}

// Where both print alike (the signs of two NaN), the field is "bytes".
template <class Message>
FieldDifference find_difference(const Message& recorded, const Message& simulated) {
  const std::vector<std::string> a = printed_lines(recorded), b = printed_lines(simulated);
  const auto [in_a, in_b] = std::mismatch(a.begin(), a.end(), b.begin(), b.end());
  const auto at = static_cast<std::size_t>(in_a - a.begin());
  if (in_a == a.end() && in_b == b.end()) return {"bytes", "differ", "differ"};
  if (in_a != a.end() && in_b != b.end() && field_of(a, at) == field_of(b, at)) {
    return {field_of(a, at), value_of(*in_a), value_of(*in_b)};
  }
  // an array of one has more elements
  if (a.size() > b.size()) return {field_of(a, at), value_of(*in_a), "none"};
  return {field_of(b, at), "none", value_of(*in_b)};
}

}  // namespace afm::bags
