// A fingerprint of the arithmetic this program was built with: equal fingerprints give equal bits.
#pragma once

#include <string>

namespace afm::node {

// Of a short run with known settings, and so of every operation that a run is made of.
std::string arithmetic_digest();

}  // namespace afm::node
