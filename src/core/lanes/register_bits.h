// What is done to the bits of a register of lanes, the same whatever its width. Include a register first; internal, as
// that is.
#pragma once

namespace afm {
namespace {

// Whole numbers kept in the bits of the lanes.
AFM_LANE_INLINE Whole whole(Register a) { return reinterpret_cast<Whole>(a); }
AFM_LANE_INLINE Register bits_in_lanes(Whole a) { return reinterpret_cast<Register>(a); }
AFM_LANE_INLINE Register plus_whole(Register a, Register b) { return bits_in_lanes(whole(a) + whole(b)); }

AFM_LANE_INLINE Whole sign_bit() { return whole(filled(-0.0)); }
AFM_LANE_INLINE Register negated(Register a) { return bits_in_lanes(whole(a) ^ sign_bit()); }
AFM_LANE_INLINE Register magnitude(Register a) { return bits_in_lanes(whole(a) & ~sign_bit()); }
// a with its sign turned round where the bits have a two in them
AFM_LANE_INLINE Register negated_by_two(Register a, Register bits) {
  return bits_in_lanes(whole(a) ^ ((whole(bits) << 62) & sign_bit()));
}

}  // namespace
}  // namespace afm
