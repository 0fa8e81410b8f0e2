// A pack of the nodes of a burst's step. Include a register of four first; internal, as that is.
#pragma once

#include "core/contact/chatter_flow.h"
#include "pack.h"

namespace afm {
namespace {

AFM_LANE_INLINE Pack portable_exp(P x) {
  return exp_detail::exp_of(x, [](P shifted) { return Pack(bits_in_lanes((whole(shifted.r) + 1023) << 52)); });
}

AFM_LANE_INLINE Pack first_of(P x) { return Pack(_mm256_permute4x64_pd(x.r, 0x00)); }
AFM_LANE_INLINE Pack second_of(P x) { return Pack(_mm256_permute4x64_pd(x.r, 0x55)); }
AFM_LANE_INLINE Pack third_of(P x) { return Pack(_mm256_permute4x64_pd(x.r, 0xAA)); }
AFM_LANE_INLINE Pack last_of(P x) { return Pack(_mm256_permute4x64_pd(x.r, 0xFF)); }
AFM_LANE_INLINE double last_number(P x) { return _mm256_cvtsd_f64(last_of(x).r); }

}  // namespace

template <>
AFM_LANE_INLINE Pack at_every_node<Pack>(const double (&x)[4]) {
  return Pack(_mm256_loadu_pd(x));
}

}  // namespace afm
