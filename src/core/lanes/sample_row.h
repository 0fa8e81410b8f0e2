// The samples of one segment of motion as plain data. Without code: files that are compiled for different machines
// share it.
#pragma once

#include <cstddef>

namespace afm {
namespace lanes {

// The times of a grid relative to the start of the motion. Precondition: all numbers are below kMaxExact, so that sums
// of whole tau are exact: a double has 53 bits.
struct SampleClock {
  double period;
  double origin_tau, origin_phase;  // of the grid; whole tau since the start of the motion
  double start_phase;               // of the motion
};
constexpr double kMaxExact = 0x1p50;

struct SampleRow {
  SampleClock clock;
  double first;  // number of the first sample on its grid
  std::size_t n;
  double* vertical;
  double* lateral;
  bool on_slide;
  // the motion: its state at the start; of a slide also the series of its displacement
  double phase, X, U, Y, W, g, g1, h, h1, fastest;
  double ratio, omega_h, inverse_omega_h, H, y0, eta;
  const double* displacement;
};

// Computes the samples and returns the lowest gap [a].
using Sampler = double (*)(const SampleRow&);

// The widest sampler of at most `width` lanes on this machine; null without lanes.
Sampler sampler_in(int width);

double sample_avx2(const SampleRow& row);
double sample_avx512(const SampleRow& row);

}  // namespace lanes
}  // namespace afm
