// Numbers as people write them, in every message of ours.
#pragma once

#include <string>

namespace afm {

// The fewest digits that give the same double back. Decimal notation from 0.0001 up to ten million (0.1, 300000) and
// where it is no longer, else powers of ten (1e-06); a decimal point, whatever the locale.
std::string number_text(double value);

// The same with at most so many digits.
std::string rounded_text(double value, int digits);

}  // namespace afm
