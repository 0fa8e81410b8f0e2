// The fast check: the run simulated again against the digests alone, so that of a large recording little is read.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "message_difference.h"
#include "recording.h"
#include "run_check.h"

namespace afm::replay {

struct DigestReport {
  Extent extent;
  std::optional<Difference> difference;  // at the first digest that differs
  ModelTime last_equal;                  // model time of the one before it, in the same epoch
};

// Throws Problem.
DigestReport check_digests(const Recording& recording, const Progress& progress);

}  // namespace afm::replay
