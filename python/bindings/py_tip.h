// A tip in Python's hands.
#pragma once

#include <cstdint>

#include "afm/tip.h"

namespace afm::python {

struct PyTip {
  Tip tip;
  std::uint64_t search_failures = 0;
};

}  // namespace afm::python
