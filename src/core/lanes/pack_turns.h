// Turns and model times of a pack.
#pragma once

#include "pack.h"

namespace afm {
namespace {

AFM_LANE_INLINE Pack nearest(P x) { return turns_detail::nearest_of(x); }
AFM_LANE_INLINE Pack turn_product(P a, P b) { return fma(a, b, -nearest(a * b)); }

// The whole number that a lane holds, in its lowest bits. |x| < 2^51.
AFM_LANE_INLINE Pack whole_bits(P x) { return x + Pack(turns_detail::kRounder); }
AFM_LANE_INLINE Pack add_whole(P a, P b) { return Pack(plus_whole(a.r, b.r)); }

AFM_LANE_INLINE SinCos<Pack> turn_quarters(P k, P s, P c) {
  const Pack next = Pack(plus_whole(k.r, filled_bits(1)));
  const Mask swap = Mask{odd(k.r)};
  const Pack sin_value = select(swap, c, s), cos_value = select(swap, s, c);
  return {Pack(negated_by_two(sin_value.r, k.r)), Pack(negated_by_two(cos_value.r, next.r))};
}
AFM_LANE_INLINE SinCos<Pack> sin_cos_turns(P x) { return turns_detail::sin_cos_of(x); }
AFM_LANE_INLINE SinCos<Pack> sin_cos_turn_product(P a, P b) { return turns_detail::sin_cos_of_product(a, b); }
AFM_LANE_INLINE SmallTurn<Pack> small_turn(P x) { return turns_detail::small_turn_of(x); }
AFM_LANE_INLINE SmallTurn<Pack> tiny_turn(P x) { return turns_detail::tiny_turn_of(x); }

// Model times: whole tau in the bits of one pack, phases in another.
struct PackTime {
  Pack tau, phase;
};

AFM_LANE_INLINE PackTime operator+(const PackTime& t, P dt) {
  const Pack sum = t.phase + dt, whole = floor(sum), phase = sum - whole;
  const Mask carried = phase >= Pack(1.0);
  const Pack zero = whole_bits(Pack(0.0)), more = whole_bits(whole + select(carried, Pack(1.0), Pack(0.0)));
  const Pack steps = Pack(minus_whole(more.r, zero.r));
  return {add_whole(t.tau, steps), select(carried, Pack(0.0), phase)};
}
AFM_LANE_INLINE Mask operator<(const PackTime& a, const PackTime& b) {
  const Mask earlier = Mask{less_whole(a.tau.r, b.tau.r)};
  const Mask same = Mask{equal_whole(a.tau.r, b.tau.r)};
  return earlier || (same && a.phase < b.phase);
}

}  // namespace
}  // namespace afm
