// Compiled for AVX2 and fused multiply-add whatever the rest is compiled for; run only where the machine has them.
#include "slide_orders.h"
#include "registers_avx2.h"

namespace afm {
namespace {

// The last lane is not asked for.
struct TrioInRegister {
  Register r;

  TrioInRegister() = default;
  explicit AFM_LANE_INLINE TrioInRegister(Register lanes) : r(lanes) {}
  AFM_LANE_INLINE TrioInRegister(double x, double y, double z) : r(_mm256_setr_pd(x, y, z, z)) {}
  AFM_LANE_INLINE double first() const { return _mm256_cvtsd_f64(r); }
  AFM_LANE_INLINE double second() const { return _mm_cvtsd_f64(_mm_unpackhi_pd(low(), low())); }
  AFM_LANE_INLINE double third() const { return _mm_cvtsd_f64(_mm256_extractf128_pd(r, 1)); }

 private:
  AFM_LANE_INLINE __m128d low() const { return _mm256_castpd256_pd128(r); }
};

AFM_LANE_INLINE TrioInRegister operator+(const TrioInRegister& a, const TrioInRegister& b) {
  return TrioInRegister(a.r + b.r);
}
AFM_LANE_INLINE TrioInRegister fma(const TrioInRegister& a, const TrioInRegister& b, const TrioInRegister& c) {
  return TrioInRegister(fused(a.r, b.r, c.r));
}

}  // namespace
}  // namespace afm

void afm::lanes::slide_orders_avx2(const SlideBeginning<double>& start, double* d, double* u, double* lambda) {
  SlideOrders<double, TrioInRegister>(start, d, u, lambda);
}
