// When samples are taken: evenly from an origin on. A new sample rate begins a new grid.
#pragma once

#include <cstdint>

#include "afm_emulator/state.h"

namespace afm {

struct SampleGrid {
  double period = 0.03;     // [tau]
  std::uint64_t first = 0;  // running index of the sample at the origin
  ModelTime origin;

  // Of the n-th sample, n >= first; from an origin at 0 to the bits of multiply().
  ModelTime time(std::uint64_t n) const {
    const ModelTime since = multiply(n - first, period);
    const double phase = origin.phase + since.phase;
    return phase < 1.0 ? ModelTime{origin.tau + since.tau, phase} : ModelTime{origin.tau + since.tau + 1, phase - 1.0};
  }
};

}  // namespace afm
