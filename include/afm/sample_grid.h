// The times of samples (and of kicks): equally spaced from an origin on. A new sample period begins a new grid.
#pragma once

#include <cmath>
#include <cstdint>

#include "state.h"

namespace afm {

// Later than the end of every run. A difference of two such times still fits in 64 bits.
constexpr ModelTime kEndOfTime{std::int64_t{1} << 60, 0.0};

// A time that a run can reach; for times that were read from elsewhere. Half of the end leaves room to go on.
inline bool is_possible(const ModelTime& time) {
  return time.tau >= 0 && time.tau < kEndOfTime.tau / 2 && time.phase >= 0.0 && time.phase < 1.0;
}

struct SampleGrid {
  double period = 0.03;     // [tau]
  std::uint64_t first = 0;  // running index of the sample at the origin
  ModelTime origin;

  // The time of the n-th sample. Precondition: n >= first. From an origin at 0 it has the bits of multiply().
  ModelTime time(std::uint64_t n) const {
    const ModelTime since = multiply(n - first, period);
    const double phase = origin.phase + since.phase;
    return phase < 1.0 ? ModelTime{origin.tau + since.tau, phase} : ModelTime{origin.tau + since.tau + 1, phase - 1.0};
  }

  // The sample that is less than `part` of a period from `time`, or `time` itself.
  ModelTime rounded(const ModelTime& time, double part) const {
    constexpr double kMostSamples = 1e15;  // as exact as a double can count
    const double count = (time - origin) / period, whole = std::round(count);
    const bool is_near = std::fabs(count - whole) < part && whole >= 0.0 && whole < kMostSamples;
    return is_near ? this->time(first + static_cast<std::uint64_t>(whole)) : time;
  }

  // As time() without a precondition, for numbers read from elsewhere: kEndOfTime for a sample that is not on the grid.
  ModelTime time_or_end(std::uint64_t n) const {
    const double since = static_cast<double>(n - first) * period;
    const bool reached = n >= first && since >= 0.0 && since < 0.5 * static_cast<double>(kEndOfTime.tau);
    return reached ? time(n) : kEndOfTime;
  }
};

}  // namespace afm
