// A pack of numbers, one in each lane, that the templates of the flight and its search can be given for their number: every
// lane goes through the arithmetic that the number would, bit for bit. Include a register first; internal, as that is.
#pragma once

#include <utility>

#include "afm_emulator/impact_search.h"
#include "afm_emulator/reflection.h"

#ifndef AFM_LANE_REGISTERS
#define AFM_LANE_REGISTERS 1  // of a pack, to hide how long one waits for itself
#endif

namespace afm {
namespace {

constexpr int kRegisters = AFM_LANE_REGISTERS, kLanes = kRegisters * kRegisterLanes;

// One register or two, by name: GCC copies arrays of them number by number.
template <class R>
struct Registers {
  R first;
#if AFM_LANE_REGISTERS == 2
  R second;

  AFM_LANE_INLINE R& operator[](int i) { return i == 0 ? first : second; }
  AFM_LANE_INLINE const R& operator[](int i) const { return i == 0 ? first : second; }
#else
  AFM_LANE_INLINE R& operator[](int) { return first; }
  AFM_LANE_INLINE const R& operator[](int) const { return first; }
#endif
};

template <class R, class F>
AFM_LANE_INLINE Registers<R> registers(const F& f) {
#if AFM_LANE_REGISTERS == 2
  return {f(0), f(1)};
#else
  return {f(0)};
#endif
}

struct Mask {
  Registers<RegisterMask> r;
};

struct Pack {
  Registers<Register> r;

  Pack() = default;
  explicit AFM_LANE_INLINE Pack(const Registers<Register>& registers) : r(registers) {}
  explicit AFM_LANE_INLINE Pack(double x) : r(registers<Register>([x](int) { return filled(x); })) {}
};

template <class F>
AFM_LANE_INLINE Pack each(const F& f) {
  return Pack(registers<Register>(f));
}
template <class F>
AFM_LANE_INLINE Mask each_mask(const F& f) {
  return {registers<RegisterMask>(f)};
}

using P = const Pack&;
using M = const Mask&;

AFM_LANE_INLINE Pack operator+(P a, P b) {
  return each([&](int i) { return a.r[i] + b.r[i]; });
}
AFM_LANE_INLINE Pack operator-(P a, P b) {
  return each([&](int i) { return a.r[i] - b.r[i]; });
}
AFM_LANE_INLINE Pack operator*(P a, P b) {
  return each([&](int i) { return a.r[i] * b.r[i]; });
}
AFM_LANE_INLINE Pack operator/(P a, P b) {
  return each([&](int i) { return a.r[i] / b.r[i]; });
}
AFM_LANE_INLINE Pack operator-(P a) {
  return each([&](int i) { return negated(a.r[i]); });
}
AFM_LANE_INLINE Pack fma(P a, P b, P c) {
  return each([&](int i) { return fused(a.r[i], b.r[i], c.r[i]); });
}
AFM_LANE_INLINE Pack abs(P a) {
  return each([&](int i) { return magnitude(a.r[i]); });
}
AFM_LANE_INLINE Pack sqrt(P a) {
  return each([&](int i) { return root(a.r[i]); });
}
AFM_LANE_INLINE Pack floor(P a) {
  return each([&](int i) { return rounded_down(a.r[i]); });
}
AFM_LANE_INLINE Pack min(P a, P b) {
  return each([&](int i) { return smaller(b.r[i], a.r[i]); });
}
AFM_LANE_INLINE Pack max(P a, P b) {
  return each([&](int i) { return larger(b.r[i], a.r[i]); });
}

AFM_LANE_INLINE Mask operator<(P a, P b) {
  return each_mask([&](int i) { return less(a.r[i], b.r[i]); });
}
AFM_LANE_INLINE Mask operator<=(P a, P b) {
  return each_mask([&](int i) { return less_equal(a.r[i], b.r[i]); });
}
AFM_LANE_INLINE Mask operator>(P a, P b) { return b < a; }
AFM_LANE_INLINE Mask operator>=(P a, P b) { return b <= a; }
AFM_LANE_INLINE Mask operator&&(M a, M b) {
  return each_mask([&](int i) { return mask_and(a.r[i], b.r[i]); });
}
AFM_LANE_INLINE Mask operator||(M a, M b) {
  return each_mask([&](int i) { return mask_or(a.r[i], b.r[i]); });
}
AFM_LANE_INLINE Mask operator!(M a) {
  return each_mask([&](int i) { return mask_not(a.r[i]); });
}

// A bit for each lane.
AFM_LANE_INLINE unsigned bits(M m) {
  unsigned all = 0;
  for (int i = 0; i < kRegisters; ++i) all |= mask_bits(m.r[i]) << (i * kRegisterLanes);
  return all;
}
constexpr unsigned kAllLanes = (1u << kLanes) - 1u;
AFM_LANE_INLINE bool any(M m) { return bits(m) != 0; }

AFM_LANE_INLINE Pack select(M m, P yes, P no) {
  return each([&](int i) { return blended(m.r[i], yes.r[i], no.r[i]); });
}
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

AFM_LANE_INLINE Pack rough(P x) { return x; }
AFM_LANE_INLINE Pack nearest(P x) { return turns_detail::nearest_of(x); }
AFM_LANE_INLINE Pack turn_product(P a, P b) { return fma(a, b, -nearest(a * b)); }

// The whole number that a lane holds, in its lowest bits. |x| < 2^51.
AFM_LANE_INLINE Pack whole_bits(P x) { return x + Pack(turns_detail::kRounder); }
AFM_LANE_INLINE Pack add_whole(P a, P b) {
  return each([&](int i) { return plus_whole(a.r[i], b.r[i]); });
}

AFM_LANE_INLINE SinCos<Pack> turn_quarters(P quarter, P s, P c) {
  const Pack k = whole_bits(quarter), next = each([&](int i) { return plus_whole(k.r[i], filled_bits(1)); });
  const Mask swap = each_mask([&](int i) { return odd(k.r[i]); });
  const Pack sin_value = select(swap, c, s), cos_value = select(swap, s, c);
  return {each([&](int i) { return negated_by_two(sin_value.r[i], k.r[i]); }),
          each([&](int i) { return negated_by_two(cos_value.r[i], next.r[i]); })};
}
AFM_LANE_INLINE SinCos<Pack> sin_cos_turns(P x) { return turns_detail::sin_cos_of(x); }
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
  const Pack steps = each([&](int i) { return minus_whole(more.r[i], zero.r[i]); });
  return {add_whole(t.tau, steps), select(carried, Pack(0.0), phase)};
}
AFM_LANE_INLINE Mask operator<(const PackTime& a, const PackTime& b) {
  const Mask earlier = each_mask([&](int i) { return less_whole(a.tau.r[i], b.tau.r[i]); });
  const Mask same = each_mask([&](int i) { return equal_whole(a.tau.r[i], b.tau.r[i]); });
  return earlier || (same && a.phase < b.phase);
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
