// A pack of numbers, one in each lane, that the templates of a flight can be given for their number: every lane goes
// through the arithmetic that the number would, bit for bit. Include a register first; internal, as that is.
#pragma once

#include "afm/flight.h"
#include "register_bits.h"

namespace afm {
namespace {

constexpr int kLanes = kRegisterLanes;

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

AFM_LANE_INLINE Pack operator+(P a, P b) { return Pack(a.r + b.r); }
AFM_LANE_INLINE Pack operator-(P a, P b) { return Pack(a.r - b.r); }
AFM_LANE_INLINE Pack operator*(P a, P b) { return Pack(a.r * b.r); }
AFM_LANE_INLINE Pack operator/(P a, P b) { return Pack(a.r / b.r); }
AFM_LANE_INLINE Pack operator-(P a) { return Pack(negated(a.r)); }
AFM_LANE_INLINE Pack fma(P a, P b, P c) { return Pack(fused(a.r, b.r, c.r)); }
AFM_LANE_INLINE Pack abs(P a) { return Pack(magnitude(a.r)); }
AFM_LANE_INLINE Pack sqrt(P a) { return Pack(root(a.r)); }
AFM_LANE_INLINE Pack floor(P a) { return Pack(rounded_down(a.r)); }
AFM_LANE_INLINE Pack min(P a, P b) { return Pack(smaller(b.r, a.r)); }
AFM_LANE_INLINE Pack max(P a, P b) { return Pack(larger(b.r, a.r)); }

AFM_LANE_INLINE Mask operator<(P a, P b) { return Mask{less(a.r, b.r)}; }
AFM_LANE_INLINE Mask operator<=(P a, P b) { return Mask{less_equal(a.r, b.r)}; }
AFM_LANE_INLINE Mask operator>(P a, P b) { return b < a; }
AFM_LANE_INLINE Mask operator>=(P a, P b) { return b <= a; }
AFM_LANE_INLINE Mask operator&&(M a, M b) { return Mask{mask_and(a.r, b.r)}; }
AFM_LANE_INLINE Mask operator||(M a, M b) { return Mask{mask_or(a.r, b.r)}; }
AFM_LANE_INLINE Mask operator!(M a) { return Mask{mask_not(a.r)}; }

// A bit for each lane.
AFM_LANE_INLINE unsigned bits(M m) { return mask_bits(m.r); }
constexpr unsigned kAllLanes = (1u << kLanes) - 1u;

AFM_LANE_INLINE Pack select(M m, P yes, P no) { return Pack(blended(m.r, yes.r, no.r)); }

template <class F, class G>
AFM_LANE_INLINE auto branch(M m, const F& yes, const G& no) {
  const unsigned lanes = bits(m);
  decltype(yes()) value{};
  if (lanes != kAllLanes) value = no();
  if (lanes != 0) value = select(m, yes(), value);
  return value;
}
AFM_LANE_INLINE Pack over(P x, double d) { return x * Pack(1.0 / d); }
AFM_LANE_INLINE Pack mul_add(P a, P b, P c) { return fma(a, b, c); }

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
