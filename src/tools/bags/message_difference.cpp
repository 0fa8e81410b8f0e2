#include "message_difference.h"

#include <algorithm>
#include <cstddef>
#include <vector>

namespace afm::bags {
namespace {

// "  phase: 0.5": the depth is 2. An array has a heading, "impacts[]", and below it "impacts[0]: ".
struct Line {
  std::size_t depth;
  std::string key, value;

  bool is_heading() const { return ends_in("[]"); }
  bool is_element() const { return ends_in("]") && !is_heading(); }

 private:
  bool ends_in(const std::string& end) const {
    return key.size() >= end.size() && key.compare(key.size() - end.size(), end.size(), end) == 0;
  }
};

std::vector<Line> lines_of(const std::string& text) {
  std::vector<Line> lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) {
    const std::size_t depth = std::min(line.find_first_not_of(' '), line.size()), colon = line.find(": ", depth);
    const bool has_value = colon != std::string::npos;
    lines.push_back({depth, line.substr(depth, has_value ? colon - depth : colon), has_value ? line.substr(colon + 2) : ""});
  }
  return lines;
}

// The key of a line behind those of the lines that it lies in.
std::string path_to(const std::vector<Line>& lines, std::size_t i) {
  std::string path = lines[i].key;
  std::size_t depth = lines[i].depth;
  while (i-- > 0) {
    if (lines[i].depth >= depth) continue;
    depth = lines[i].depth;
    if (!lines[i].is_heading()) path = lines[i].key + "." + path;
  }
  return path;
}

}  // namespace

FieldDifference first_difference(const std::string& recorded, const std::string& simulated) {
  const std::vector<Line> a = lines_of(recorded), b = lines_of(simulated);
  for (std::size_t i = 0; i < std::max(a.size(), b.size()); ++i) {
    const bool both = i < a.size() && i < b.size() && a[i].key == b[i].key && a[i].depth == b[i].depth;
    if (both && a[i].value == b[i].value) continue;
    if (both) return {path_to(a, i), a[i].value, b[i].value};
    // an array of one ends first
    if (i < a.size() && a[i].is_element()) return {path_to(a, i), a[i].value, "none"};
    if (i < b.size()) return {path_to(b, i), "none", b[i].value};
  }
  return {"bytes", "differ", "differ"};
}

}  // namespace afm::bags
