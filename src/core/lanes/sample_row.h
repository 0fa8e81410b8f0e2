// Samples of one arc, for lanes to compute. No code of its own: it is shared by files that are compiled for different
// machines.
#pragma once

#include <cstddef>

namespace afm {
namespace lanes {

// Times of a grid, counted from the start of an arc. All of it is numbers below kMostExact, so that sums of whole tau
// are exact.
struct SampleClock {
  double period;
  double origin_tau, origin_phase;  // of the grid; whole tau since the start of the arc
  double start_phase;               // of the arc
};
constexpr double kMostExact = 0x1p50;

struct SampleRow {
  SampleClock clock;
  double first;  // count of the first on its grid
  std::size_t n;
  double* vertical;
  double* lateral;
  bool on_slide;
  // the arc: its start, and of a reference slide the series of its displacement
  double phase, X, U, Y, W, g, g1, h, h1, fastest;
  double ratio, omega_h, inverse_omega_h, H, y0, eta;
  const double* displacement;
};

// Computes them; returns the lowest gap.
using Sampler = double (*)(const SampleRow&);

// At most so many at once, on the machine this runs on; null where it has no lanes.
Sampler sampler_in(int width);

double sample_avx2(const SampleRow& row);
double sample_avx512(const SampleRow& row);

}  // namespace lanes
}  // namespace afm
