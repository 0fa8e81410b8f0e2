#include "printed_fields.h"

#include <algorithm>
#include <cctype>
#include <cstdlib>

namespace afm::replay {
namespace {

// "  vertical[3]: 1.5": depth 2, key "vertical[3]", value "1.5".
struct Line {
  explicit Line(const std::string& text) : depth(std::min(text.find_first_not_of(' '), text.size())) {
    const std::size_t colon = text.find(':', depth);
    key = text.substr(depth, colon - depth);
    if (colon != std::string::npos && colon + 2 < text.size()) value = text.substr(colon + 2);
  }
  bool is_element() const { return key.size() > 2 && key.back() == ']' && std::isdigit(key[key.size() - 2]); }

  std::size_t depth;
  std::string key, value;
};

struct Open {
  std::size_t depth;
  std::string name;
};

}  // namespace

std::string topic_name(const std::string& datatype) {
  std::string name;
  for (const char c : datatype.substr(datatype.find('/') + 1)) {
    if (std::isupper(c) && !name.empty()) name += '_';
    name += static_cast<char>(std::tolower(c));
  }
  return name;
}

std::vector<PrintedField> parse_fields(const std::string& message_name, const std::string& text) {
  std::vector<PrintedField> fields;
  std::vector<Open> open{{0, message_name}};  // the fields that the present line lies in
  std::istringstream lines(text);
  for (std::string one; std::getline(lines, one);) {
    const Line line(one);
    while (open.size() > 1 && open.back().depth >= line.depth) open.pop_back();
    if (line.is_element()) {
      fields.push_back({open.back().name, line.value, std::strtoul(&line.key[line.key.rfind('[') + 1], nullptr, 10)});
      continue;
    }
    fields.push_back({open.back().name + "." + line.key.substr(0, line.key.find('[')), line.value, 0});
    if (line.value.empty()) open.push_back({line.depth, fields.back().name});
  }
  return fields;
}

FieldDifference first_difference(const std::vector<PrintedField>& a, const std::vector<PrintedField>& b) {
  const auto agree = [](const PrintedField& p, const PrintedField& q) {
    return p.name == q.name && p.value == q.value && p.index == q.index;
  };
  const auto [p, q] = std::mismatch(a.begin(), a.end(), b.begin(), b.end(), agree);
  if (p == a.end() && q == b.end()) return {"bytes", "differ", "differ", 0};
  if (p != a.end() && q != b.end() && p->name == q->name) return {p->name, p->value, q->value, p->index};
  // an array of one ends first
  const auto size_of = [](const std::vector<PrintedField>& fields, const std::string& name) {
    // less the heading
    return std::to_string(std::count_if(fields.begin(), fields.end(), [&](const auto& f) { return f.name == name; }) -
                          1);
  };
  const std::string array = std::prev(p)->name;
  return {"size of " + array, size_of(a, array), size_of(b, array), 0};
}

}  // namespace afm::replay
