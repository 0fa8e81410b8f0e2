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

  // The one that all go, or none: kKinds.
  AFM_LANE_INLINE int common() const {
    int kind = 0;
    while (kind < kKinds && lanes[kind] != kAllLanes) ++kind;
    return kind;
  }
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

// What is done to a pair of numbers, and the place of the first in each row.
struct Load {
  const Rows& rows;
  AFM_LANE_INLINE void operator()(int at, Pack& first, Pack& second) const { rows.load(at, first, second); }
};
struct Store {
  const Rows& rows;
  AFM_LANE_INLINE void operator()(int at, P first, P second) const { rows.store(at, first, second); }
};

AFM_LANE_INLINE void split(unsigned lanes, M first, Kind yes, Kind no, Ways& ways) {
  ways.lanes[yes] |= lanes & bits(first);
  ways.lanes[no] |= lanes & ~bits(first);
}

}  // namespace
}  // namespace afm
