// A pack of numbers, one in each lane of a vector register, as a number type for the templates of a flight. Guarantee:
// each lane gives the same bits as the number alone. Include a register first (registers_avx2.h). Everything is
// internal to the file that includes it.
#pragma once

#include "afm/flight.h"

namespace afm {
namespace {

struct Mask {
  RegisterMask r;
};

struct Pack {
  Register r;

  Pack() = default;
  explicit AFM_LANE_INLINE Pack(Register lanes) : r(lanes) {}
  explicit AFM_LANE_INLINE Pack(double x) : r(filled(x)) {}
};

using P = const Pack&;
using M = const Mask&;

// The lanes as integers with the same bits.
AFM_LANE_INLINE Whole whole(P a) { return reinterpret_cast<Whole>(a.r); }
AFM_LANE_INLINE Pack from_whole(Whole a) { return Pack(reinterpret_cast<Register>(a)); }
AFM_LANE_INLINE Whole sign_bit() { return whole(Pack(-0.0)); }

AFM_LANE_INLINE Pack operator+(P a, P b) { return Pack(a.r + b.r); }
AFM_LANE_INLINE Pack operator-(P a, P b) { return Pack(a.r - b.r); }
AFM_LANE_INLINE Pack operator*(P a, P b) { return Pack(a.r * b.r); }
AFM_LANE_INLINE Pack operator-(P a) { return from_whole(whole(a) ^ sign_bit()); }
AFM_LANE_INLINE Pack fma(P a, P b, P c) { return Pack(fused(a.r, b.r, c.r)); }
AFM_LANE_INLINE Pack floor(P a) { return Pack(rounded_down(a.r)); }
AFM_LANE_INLINE Pack min(P a, P b) { return Pack(smaller(b.r, a.r)); }
AFM_LANE_INLINE Pack over(P x, double d) { return x * Pack(1.0 / d); }
AFM_LANE_INLINE Pack mul_add(P a, P b, P c) { return fma(a, b, c); }

AFM_LANE_INLINE Mask operator<(P a, P b) { return Mask{less(a.r, b.r)}; }
AFM_LANE_INLINE Mask operator<=(P a, P b) { return Mask{less_equal(a.r, b.r)}; }
AFM_LANE_INLINE Mask operator>=(P a, P b) { return b <= a; }
AFM_LANE_INLINE Pack select(M m, P yes, P no) { return Pack(blended(m.r, yes.r, no.r)); }

// Both sides where lanes differ; a side that no lane takes is skipped.
template <class F, class G>
AFM_LANE_INLINE auto branch(M m, const F& yes, const G& no) {
  const unsigned lanes = mask_bits(m.r);
  decltype(yes()) value{};
  if (lanes != (1u << kLanes) - 1u) value = no();
  if (lanes != 0) value = select(m, yes(), value);
  return value;
}

// Sine and cosine in turns, as in afm/detail/turns.h.
AFM_LANE_INLINE Pack nearest(P x) { return turns_detail::nearest_of(x); }
AFM_LANE_INLINE Pack turn_product(P a, P b) { return fma(a, b, -nearest(a * b)); }

// a with the opposite sign where the second bit of k is set.
AFM_LANE_INLINE Pack negated_by_two(P a, Whole k) { return from_whole(whole(a) ^ ((k << 62) & sign_bit())); }
AFM_LANE_INLINE SinCos<Pack> turn_quarters(P quarters, P s, P c) {
  const Whole k = whole(quarters);
  const Mask swap = Mask{odd(quarters.r)};
  return {negated_by_two(select(swap, c, s), k), negated_by_two(select(swap, s, c), k + 1)};
}
AFM_LANE_INLINE SinCos<Pack> sin_cos_turns(P x) { return turns_detail::sin_cos_of(x); }
AFM_LANE_INLINE SinCos<Pack> sin_cos_turn_product(P a, P b) { return turns_detail::sin_cos_of_product(a, b); }
AFM_LANE_INLINE SmallTurn<Pack> small_turn(P x) { return turns_detail::small_turn_of(x); }

}  // namespace

template <>
AFM_LANE_INLINE Pack epsilon<Pack>() {
  return Pack(0x1p-52);
}
template <>
AFM_LANE_INLINE Pack two_pi<Pack>() {
  return Pack(kTwoPi);
}

}  // namespace afm
