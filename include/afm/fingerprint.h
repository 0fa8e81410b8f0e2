// A fingerprint of the arithmetic this library was built with: equal fingerprints give equal bits.
#pragma once

#include <string>

namespace afm {

// 16 hexadecimal digits, of short runs that contain every operation.
std::string arithmetic_fingerprint();

}  // namespace afm
