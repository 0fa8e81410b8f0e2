// What a check of a recording can come to: exit codes, and the exception that carries one.
#pragma once

#include <stdexcept>
#include <string>

namespace afm::replay {

enum class Verdict : int {
  sound = 0,      // identical, nothing missing, closed
  differs = 1,    // recorded as published, but simulated again it gives other bits
  usage = 2,      // wrong arguments
  foreign = 3,    // no recording of this emulator, or of another version of it
  truncated = 4,  // no index, damaged, or never closed
  missing = 5,    // messages are not there
  reordered = 6,  // messages are not in their order
  altered = 7     // not what was published: the digests recorded with it say otherwise
};

struct Problem : std::runtime_error {
  Problem(Verdict its_verdict, const std::string& what) : std::runtime_error(what), verdict(its_verdict) {}
  Verdict verdict;
};

}  // namespace afm::replay
