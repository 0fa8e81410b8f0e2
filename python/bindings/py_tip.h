// A tip in Python's hands.
#pragma once

#include <cstdint>

#include "afm/tip.h"

namespace afm::python {

struct PyTip {
  Tip tip;
  std::uint64_t earlier_failures = 0;  // of searches, before it was pickled

  std::uint64_t search_failures() const { return earlier_failures + tip.search_failures(); }
};

}  // namespace afm::python
