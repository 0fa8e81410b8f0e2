#pragma once

#include <array>
#include <cstdio>
#include <string>

namespace afm::view {

// printf into a string; what does not fit is cut off.
template <class... Values>
std::string text(const char* format, Values... values) {
  std::array<char, 200> buffer{};
  std::snprintf(buffer.data(), buffer.size(), format, values...);
  return buffer.data();
}

}  // namespace afm::view
