// When samples are taken: evenly from an origin on. A new sample rate begins a new grid.
#pragma once

#include <cstdint>

#include "afm/state.h"

namespace afm {

// No run gets so far; a difference of two such times is still a number of tau.
constexpr ModelTime kEndOfTime{std::int64_t{1} << 60, 0.0};

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

  // The same for any number at all, such as one that was read somewhere; what is not on the grid is at the end of time.
  ModelTime time_or_end(std::uint64_t n) const {
    const bool reached =
        n >= first && static_cast<double>(n - first) * period < 0.5 * static_cast<double>(kEndOfTime.tau);
    return reached ? time(n) : kEndOfTime;
  }
};

}  // namespace afm
