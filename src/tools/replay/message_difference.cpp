#include "message_difference.h"

#include <algorithm>

namespace afm::replay {
namespace {

FieldDifference numbers(const char* field, std::uint64_t first, std::uint64_t second, std::size_t index) {
  return {field, std::to_string(first), std::to_string(second), index};
}

}  // namespace

std::optional<FieldDifference> find_difference(const afm_emulator::ImpactArray& a, const afm_emulator::ImpactArray& b) {
  if (a.first_index != b.first_index) return numbers("impacts.first_index", a.first_index, b.first_index, 0);
  const auto same = [](const auto& p, const auto& q) { return node::bytes_of(p) == node::bytes_of(q); };
  const auto [p, q] = std::mismatch(a.impacts.begin(), a.impacts.end(), b.impacts.begin(), b.impacts.end(), same);
  const auto index = static_cast<std::size_t>(p - a.impacts.begin());
  if (p != a.impacts.end() && q != b.impacts.end()) {
    FieldDifference difference = first_difference(printed_fields("impacts", *p), printed_fields("impacts", *q));
    difference.index = index;
    return difference;
  }
  if (a.impacts.size() == b.impacts.size()) return {};
  return numbers("number of impacts", a.impacts.size(), b.impacts.size(), index);
}

}  // namespace afm::replay
