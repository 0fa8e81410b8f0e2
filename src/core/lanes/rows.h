// The tips of a pack: their rows of numbers, and which way each goes next.
#pragma once

#include "lane_tip.h"
#include "pack_turns.h"

namespace afm {
namespace {

using lanes::LaneTip;
using namespace lanes;  // the fields

constexpr double kMostEvaluations = 200;  // a flight that takes more is the tip's own affair

// What lanes wait for, each in a list of its own: in a pack all go one way.
enum Kind : int {
  kLookNear,    // the gap of the search, by small turns from the start
  kLookFar,     // likewise, by whole turns
  kFinishHere,  // the root, from the jet as it is
  kFinishTiny,  // by tiny turns from it
  kFinishNear,  // by small turns
  kFinishFar,   // from the start
  kBounce,
  kKinds,
  kAlone = kKinds,
  kLimited,
  kWays
};

// A bit for each lane, for each way it can go.
struct Ways {
  unsigned lanes[kWays] = {};
};

// The rows of the tips in a pack.
struct Rows {
  double* row[kLanes];

  explicit AFM_LANE_INLINE Rows(LaneTip* const* tips) {
    for (int i = 0; i < kLanes; ++i) row[i] = tips[i]->row;
  }
  AFM_LANE_INLINE void load(int at, Pack& first, Pack& second) const { load_pair(row, at, first.r, second.r); }
  AFM_LANE_INLINE void store(int at, P first, P second) const { store_pair(row, at, first.r, second.r); }
};

AFM_LANE_INLINE void load_model(const Rows& rows, Mechanics<Pack>& m, Pack& eta) {
  rows.load(kRatio, m.ratio, m.omega_h);
  rows.load(kPerOmegaH, m.per_omega_h, m.H);
  rows.load(kCentre, m.y0, eta);
  m.omega_v = Pack(kTwoPi);
  m.per_omega_v = Pack(1.0 / kTwoPi);
}

AFM_LANE_INLINE Flight<Pack> load_flight(const Rows& rows) {
  Mechanics<Pack> m;
  Pack eta, u;
  load_model(rows, m, eta);
  GapJet<Pack> start;
  FlightBounds<Pack> b;
  start.g = Pack(0.0);
  rows.load(kPhase, start.state.phase, u);
  rows.load(kX, start.state.X, start.state.U);
  rows.load(kY, start.state.Y, start.state.W);
  rows.load(kG1, start.g1, start.g2);
  rows.load(kG3, start.g3, start.h);
  rows.load(kH1, start.h1, b.X);
  rows.load(kBoundY, b.Y, b.second);
  rows.load(kBound3, b.third, b.fourth);
  rows.load(kBoundDrive, b.drive, b.fastest);
  return Flight<Pack>(m, eta, start, b);
}

// The same way round; u: the horizontal velocity at the launch.
AFM_LANE_INLINE void store_flight(const Rows& rows, const Flight<Pack>& f, P u) {
  const GapJet<Pack>& o = f.start();
  const FlightBounds<Pack>& b = f.bounds();
  rows.store(kPhase, o.state.phase, u);
  rows.store(kX, o.state.X, o.state.U);
  rows.store(kY, o.state.Y, o.state.W);
  rows.store(kG1, o.g1, o.g2);
  rows.store(kG3, o.g3, o.h);
  rows.store(kH1, o.h1, b.X);
  rows.store(kBoundY, b.Y, b.second);
  rows.store(kBound3, b.third, b.fourth);
  rows.store(kBoundDrive, b.drive, b.fastest);
}

AFM_LANE_INLINE void split(unsigned lanes, M first, Kind yes, Kind no, Ways& ways) {
  ways.lanes[yes] |= lanes & bits(first);
  ways.lanes[no] |= lanes & ~bits(first);
}

}  // namespace
}  // namespace afm
