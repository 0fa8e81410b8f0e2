// One vector register of AVX2, with four lanes. Everything is internal to the file that includes it: code that is
// compiled for this machine must not be linked into a program for another one.
#pragma once

#include <immintrin.h>

#define AFM_LANE_INLINE inline __attribute__((always_inline))

namespace afm {
namespace {

constexpr int kLanes = 4;
using Register = __m256d;
using RegisterMask = __m256d;  // all bits of a lane, or none
typedef unsigned long long Whole __attribute__((vector_size(32)));

AFM_LANE_INLINE Register filled(double x) { return _mm256_set1_pd(x); }
AFM_LANE_INLINE Register fused(Register a, Register b, Register c) { return _mm256_fmadd_pd(a, b, c); }
// b if neither is smaller, as std::min(b, a)
AFM_LANE_INLINE Register smaller(Register a, Register b) { return _mm256_min_pd(a, b); }
AFM_LANE_INLINE Register rounded_down(Register a) { return _mm256_floor_pd(a); }
AFM_LANE_INLINE Register blended(RegisterMask m, Register yes, Register no) { return _mm256_blendv_pd(no, yes, m); }

AFM_LANE_INLINE RegisterMask less(Register a, Register b) { return _mm256_cmp_pd(a, b, _CMP_LT_OQ); }
AFM_LANE_INLINE RegisterMask less_equal(Register a, Register b) { return _mm256_cmp_pd(a, b, _CMP_LE_OQ); }
AFM_LANE_INLINE unsigned mask_bits(RegisterMask a) { return static_cast<unsigned>(_mm256_movemask_pd(a)); }

// The last bit of each lane.
AFM_LANE_INLINE RegisterMask odd(Register bits) {
  const __m256i low = _mm256_slli_epi64(_mm256_castpd_si256(bits), 63);
  return _mm256_castsi256_pd(_mm256_cmpgt_epi64(_mm256_setzero_si256(), low));
}

AFM_LANE_INLINE Register lane_numbers() { return _mm256_setr_pd(0.0, 1.0, 2.0, 3.0); }
AFM_LANE_INLINE void store_row(double* row, Register a) { _mm256_storeu_pd(row, a); }

}  // namespace
}  // namespace afm
