// A snapshot as a dict of numbers and arrays in natural units: of a run, or of a tip alone.
#pragma once

#include "afm/run.h"
#include "convert.h"

namespace afm::python {

py::dict to_dict(const Snapshot& snapshot);
Snapshot to_snapshot(const py::dict& dict);  // throws Faults

inline void require_settled(bool settled) {
  if (!settled) throw py::value_error("a command has left an event to report: advance to the present first");
}

}  // namespace afm::python
