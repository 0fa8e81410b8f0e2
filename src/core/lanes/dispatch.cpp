// What the compiler could make and the machine can run. For any machine: compiled like the rest.
#include "lane_tip.h"
#include "node_step.h"
#include "sample_row.h"
#include "slide_orders.h"

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
Advance advance_in(int width) { return chosen(width, advance_avx2, advance_avx512); }
Sampler sampler_in(int width) { return chosen(width, sample_avx2, sample_avx512); }
#else
Advance advance_in(int width) { return chosen(width, advance_avx2, advance_avx2); }
Sampler sampler_in(int width) { return chosen(width, sample_avx2, sample_avx2); }
#endif
NodeStep node_step() { return widest(4) == 4 ? node_step_avx2 : nullptr; }
WriteSlideOrders slide_orders() { return widest(4) == 4 ? slide_orders_avx2 : nullptr; }
#else
Advance advance_in(int) { return nullptr; }
Sampler sampler_in(int) { return nullptr; }
NodeStep node_step() { return nullptr; }
WriteSlideOrders slide_orders() { return nullptr; }
#endif

}  // namespace lanes
}  // namespace afm
