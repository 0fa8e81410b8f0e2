// An impact: its record, and the flight that follows.
#pragma once

#include <cstddef>

#include "root.h"

namespace afm {
namespace {

// An impact's record is a row too.
static_assert(sizeof(Impact) == 56 && offsetof(Impact, time) == 0 && offsetof(Impact, surface_phase) == 16 &&
                  offsetof(Impact, normal_speed) == 24 && offsetof(Impact, tangential_velocity) == 32 &&
                  offsetof(Impact, energy_loss) == 40 && offsetof(Impact, kind) == 48 && offsetof(Impact, count) == 52,
              "the record of an impact is stored by pairs of numbers");

AFM_LANE_INLINE void log(LaneTip* const* tips, const PackTime& time, const ReflectionOf<Pack>& r) {
  double* row[kLanes];
  for (int i = 0; i < kLanes; ++i) row[i] = reinterpret_cast<double*>(&tips[i]->last);
  store_pair(row, 0, time.tau.r, time.phase.r);
  store_pair(row, 2, r.after.phase.r, r.normal_speed.r);
  store_pair(row, 4, r.tangential_velocity.r, r.energy_loss.r);
  for (int i = 0; i < kLanes; ++i) {
    tips[i]->last.kind = ImpactKind::impact;
    tips[i]->last.count = 1;
  }
}

// The reflection, its record, and the flight that it begins (Tip::land and take_off).
AFM_LANE_INLINE Ways bounce(Live& live) {
  live.ask_for_law();
  const Mechanics<Pack> m = live.flight.mechanics();
  const Pack eta = live.flight.eta();
  const Incident& end = live.incident;
  GapJet<Pack> incident{};
  incident.state.phase = end.phase, incident.state.X = end.X, incident.state.U = end.U;
  incident.g1 = end.g1, incident.h1 = end.h1;
  const ReflectionOf<Pack> r = reflect(live.law, eta, incident);
  log(live.tips, end.time, r);
  const Flight<Pack>& f = live.flight = Flight<Pack>(m, eta, r.after);
  live.start = end.time;
  live.whole = true;
  live.newer = Live::kFlight | Live::kLook;
  const GapJet<Pack>& o = f.start();
  Look& look = live.look;
  search_detail::take_off(f, look.s, look.ahead, look.guess);
  const Pack zero(0.0);
  look.count = zero;
  const Mask ordinary = o.g1 > Pack(kSlowestLaunch) && !(o.g2 < zero && o.g1 <= live.burst_gap_rate);
  const RootInterval<Pack> root = search_detail::root_from_launch(f);
  const unsigned certain = bits(ordinary && root.certain);
  if (certain != 0) hold_root(live, o, zero, root);
  Ways ways;
  ways.lanes[kFinishFar] = certain;
  split(bits(ordinary) & ~certain, f.is_small(look.s + look.ahead), kLookNear, kLookFar, ways);
  ways.lanes[kAlone] = kAllLanes & ~bits(ordinary);
  return ways;
}

}  // namespace
}  // namespace afm
