// FROM:TO:STEP in decimal: each value is the double nearest to the decimal number meant, of up to 15 digits.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace afm {

constexpr std::size_t kMostRangeValues = 1000000;

// FROM, FROM + STEP, ... up to TO, and TO itself where a step meets it; or one number. Throws std::invalid_argument
// with the reason (no name, no value) where the text is no range.
std::vector<double> parse_range(const std::string& text);

}  // namespace afm
