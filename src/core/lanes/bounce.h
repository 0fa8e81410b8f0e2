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
AFM_LANE_INLINE Ways bounce(LaneTip* const* tips, const Rows& rows) {
  Mechanics<Pack> m;
  Pack eta, burst;
  load_model(rows, m, eta);
  ReflectionLaw<Pack> law;
  rows.load(kMobility, law.free, law.gamma);
  rows.load(kCutoff, law.v_c, burst);
  GapJet<Pack> incident{};
  Pack unused;
  rows.load(kJetPhase, incident.state.phase, incident.state.X);
  rows.load(kJetRateX, incident.state.U, incident.g1);
  rows.load(kJetRateY, incident.h1, unused);
  PackTime time;
  rows.load(kEndTau, time.tau, time.phase);
  const ReflectionOf<Pack> r = reflect(law, eta, incident);
  log(tips, time, r);
  const Flight<Pack> f(m, eta, r.after);
  const GapJet<Pack>& o = f.start();
  Pack s, ahead, guess;
  search_detail::take_off(f, s, ahead, guess);
  store_flight(rows, f, r.after.u);
  rows.store(kS, s, ahead);
  rows.store(kGuess, guess, Pack(0.0));
  rows.store(kStartTau, time.tau, time.phase);
  const Pack zero(0.0);
  const Mask ordinary = o.g1 > Pack(kSlowestLaunch) && !(o.g2 < zero && o.g1 <= burst);
  const Pack length = search_detail::parabola_length(f);
  const unsigned brief = bits(ordinary && search_detail::is_brief(f, length));
  if (brief != 0) store_root(rows, o, zero, search_detail::brief_root(f, length));
  Ways ways;
  ways.lanes[kFinishFar] = brief;
  split(bits(ordinary) & ~brief, f.is_small(s + ahead), kLookNear, kLookFar, ways);
  ways.lanes[kAlone] = kAllLanes & ~bits(ordinary);
  return ways;
}

}  // namespace
}  // namespace afm
