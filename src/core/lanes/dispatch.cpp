#include "lane_tip.h"

namespace afm {
namespace lanes {

// What the compiler could make and the machine can run. For any machine: compiled like the rest.
Advance advance_in(int width) {
#ifdef AFM_LANES
  const bool avx2 = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
#ifdef AFM_WIDE_LANES
  if (width >= 8 && avx2 && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq"))
    return advance_avx512;
#endif
  if (width >= 4 && avx2) return advance_avx2;
#endif
  static_cast<void>(width);
  return nullptr;
}

}  // namespace lanes
}  // namespace afm
