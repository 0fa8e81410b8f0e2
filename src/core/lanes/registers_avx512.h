// One vector register of AVX-512, with eight lanes. See registers_avx2.h.
#pragma once

#include <immintrin.h>

#define AFM_LANE_INLINE inline __attribute__((always_inline))

namespace afm {
namespace {

constexpr int kLanes = 8;
using Register = __m512d;
using RegisterMask = __mmask8;
typedef unsigned long long Whole __attribute__((vector_size(64)));

AFM_LANE_INLINE Register filled(double x) { return _mm512_set1_pd(x); }
AFM_LANE_INLINE Register fused(Register a, Register b, Register c) { return _mm512_fmadd_pd(a, b, c); }
AFM_LANE_INLINE Register smaller(Register a, Register b) { return _mm512_min_pd(a, b); }
AFM_LANE_INLINE Register rounded_down(Register a) {
  return _mm512_roundscale_pd(a, _MM_FROUND_TO_NEG_INF | _MM_FROUND_NO_EXC);
}
AFM_LANE_INLINE Register blended(RegisterMask m, Register yes, Register no) { return _mm512_mask_blend_pd(m, no, yes); }

AFM_LANE_INLINE RegisterMask less(Register a, Register b) { return _mm512_cmp_pd_mask(a, b, _CMP_LT_OQ); }
AFM_LANE_INLINE RegisterMask less_equal(Register a, Register b) { return _mm512_cmp_pd_mask(a, b, _CMP_LE_OQ); }
AFM_LANE_INLINE unsigned mask_bits(RegisterMask a) { return a; }

AFM_LANE_INLINE RegisterMask odd(Register bits) {
  return _mm512_test_epi64_mask(_mm512_castpd_si512(bits), _mm512_set1_epi64(1));
}

AFM_LANE_INLINE Register lane_numbers() { return _mm512_setr_pd(0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0); }
AFM_LANE_INLINE void store_row(double* row, Register a) { _mm512_storeu_pd(row, a); }

}  // namespace
}  // namespace afm
