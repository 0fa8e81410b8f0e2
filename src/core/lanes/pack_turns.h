// Turns of a pack.
#pragma once

#include "pack.h"

namespace afm {
namespace {

AFM_LANE_INLINE Pack nearest(P x) { return turns_detail::nearest_of(x); }
AFM_LANE_INLINE Pack turn_product(P a, P b) { return fma(a, b, -nearest(a * b)); }

AFM_LANE_INLINE SinCos<Pack> turn_quarters(P k, P s, P c) {
  const Pack next = Pack(plus_whole(k.r, filled_bits(1)));
  const Mask swap = Mask{odd(k.r)};
  const Pack sin_value = select(swap, c, s), cos_value = select(swap, s, c);
  return {Pack(negated_by_two(sin_value.r, k.r)), Pack(negated_by_two(cos_value.r, next.r))};
}
AFM_LANE_INLINE SinCos<Pack> sin_cos_turns(P x) { return turns_detail::sin_cos_of(x); }
AFM_LANE_INLINE SinCos<Pack> sin_cos_turn_product(P a, P b) { return turns_detail::sin_cos_of_product(a, b); }
AFM_LANE_INLINE SmallTurn<Pack> small_turn(P x) { return turns_detail::small_turn_of(x); }

}  // namespace
}  // namespace afm
