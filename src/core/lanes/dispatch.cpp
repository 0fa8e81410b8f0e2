// Chooses among the samplers that were compiled by what the machine can run.
#include "sample_row.h"

namespace afm {
namespace lanes {

Sampler sampler_in([[maybe_unused]] int width) {
#ifdef AFM_LANES
  const bool avx2 = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
#ifdef AFM_WIDE_LANES
  const bool avx512 = __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq");
  if (width >= 8 && avx2 && avx512) return sample_avx512;
#endif
  if (width >= 4 && avx2) return sample_avx2;
#endif
  return nullptr;
}

}  // namespace lanes
}  // namespace afm
