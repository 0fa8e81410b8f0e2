// What packs of lanes make of numbers, for lanes_test.cpp: compiled once for each kind of lane, called where the
// machine has it.
#pragma once

#include <cstdint>

namespace afm {

constexpr int kProbeLanes = 8, kProbeResults = 19;

// results[k][i]: the k-th function of x[i], y[i], z[i].
using LaneProbe = void (*)(const double* x, const double* y, const double* z,
                           double results[kProbeResults][kProbeLanes]);

void probe_avx2(const double* x, const double* y, const double* z, double results[kProbeResults][kProbeLanes]);
void probe_avx512(const double* x, const double* y, const double* z, double results[kProbeResults][kProbeLanes]);

}  // namespace afm
