// What the compiler could make and the machine can run. For any machine: compiled like the rest.
#include "sample_row.h"

namespace afm {
namespace lanes {
#ifdef AFM_LANES
namespace {

// How many numbers in one register, at most `width`; 1: no lanes.
int widest(int width) {
  const bool avx2 = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
#ifdef AFM_WIDE_LANES
  if (width >= 8 && avx2 && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq")) return 8;
#endif
  return width >= 4 && avx2 ? 4 : 1;
}

template <class Function>
Function chosen(int width, Function four, Function eight) {
  const int lanes = widest(width);
  return lanes == 8 ? eight : lanes == 4 ? four : nullptr;
}

}  // namespace

#ifdef AFM_WIDE_LANES
Sampler sampler_in(int width) { return chosen(width, sample_avx2, sample_avx512); }
#else
Sampler sampler_in(int width) { return chosen(width, sample_avx2, sample_avx2); }
#endif
#else
Sampler sampler_in(int) { return nullptr; }
#endif

}  // namespace lanes
}  // namespace afm
