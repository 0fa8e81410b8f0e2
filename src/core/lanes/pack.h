// A pack of numbers, one in each lane, that the templates of the flight and its search can be given for their number:
// every lane goes through the arithmetic that the number would, bit for bit. Include a register first; internal, as
// that is.
#pragma once

#include <utility>

#include "afm/impact_search.h"
#include "afm/reflection.h"
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
AFM_LANE_INLINE FlightState<Pack> select(M m, const FlightState<Pack>& a, const FlightState<Pack>& b) {
  return {select(m, a.phase, b.phase), select(m, a.X, b.X), select(m, a.U, b.U), select(m, a.Y, b.Y),
          select(m, a.W, b.W)};
}
AFM_LANE_INLINE GapJet<Pack> select(M m, const GapJet<Pack>& a, const GapJet<Pack>& b) {
  return {select(m, a.g, b.g),         select(m, a.g1, b.g1), select(m, a.g2, b.g2), select(m, a.g3, b.g3),
          select(m, a.state, b.state), select(m, a.h, b.h),   select(m, a.h1, b.h1)};
}
AFM_LANE_INLINE RootInterval<Pack> select(M m, const RootInterval<Pack>& a, const RootInterval<Pack>& b) {
  return {(m && a.certain) || (!m && b.certain), select(m, a.estimate, b.estimate), select(m, a.low, b.low),
          select(m, a.high, b.high)};
}

template <class F, class G>
AFM_LANE_INLINE auto choose(M m, const F& yes, const G& no) {
  return select(m, yes(), no());
}
template <class F, class G>
AFM_LANE_INLINE auto either(M m, const F& yes, const G& no) {
  const unsigned lanes = bits(m);
  decltype(yes()) value{};
  if (lanes != kAllLanes) value = no();
  if (lanes != 0) value = select(m, yes(), value);
  return value;
}
template <class F>
AFM_LANE_INLINE Mask both(M m, const F& rest) {
  return m && rest();
}

AFM_LANE_INLINE Pack over(P x, double d) { return x * Pack(1.0 / d); }
AFM_LANE_INLINE Pack mul_add(P a, P b, P c) { return fma(a, b, c); }

AFM_LANE_INLINE Pack rough(P x) { return x; }

// As the template, with one division for both of its ways.
AFM_LANE_INLINE Pack first_root(P g, P g1, P q, P none) {
  const Pack discriminant = g1 * g1 - Pack(2.0) * q * g, root = sqrt(discriminant), zero(0.0);
  const Mask falling = g1 < zero;
  const Pack value = select(falling, Pack(2.0) * g, g1 + root) / select(falling, root - g1, -q);
  return select(discriminant < zero || (!falling && !(q < zero)), none, value);
}

struct PackLaunch {
  Pack phase, X, u, g, g1;
};

}  // namespace

template <>
struct LaunchOf<Pack> {
  using State = PackLaunch;
};
template <>
AFM_LANE_INLINE Pack epsilon<Pack>() {
  return Pack(0x1p-52);
}
template <>
AFM_LANE_INLINE Pack two_pi<Pack>() {
  return Pack(kTwoPi);
}

}  // namespace afm
