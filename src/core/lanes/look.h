// A look of the search: is there a root near, and where is the next look?
#pragma once

#include "root.h"

namespace afm {
namespace {

// Those that have certified a root.
AFM_LANE_INLINE void begin_root(const Rows& rows, const Flight<Pack>& f, const GapJet<Pack>& jet, P p,
                                const RootInterval<Pack>& root, unsigned certain, Ways& ways) {
  store_root(rows, jet, p, root);
  const unsigned here = certain & bits(search_detail::is_there(f, jet, root, p));
  ways.lanes[kFinishHere] = here;
  split_by_step(certain & ~here, f, p, root.estimate, ways);
}

// Where the search has come to.
struct Look {
  Pack s, ahead, guess, count, p;  // as in lane_tip.h; where this look was
  Mask jumped;                     // over what it does not certify
};

// Those that have not: where they look next.
AFM_LANE_INLINE void look_on(const Rows& rows, const Flight<Pack>& f, const GapJet<Pack>& jet, P error, const Look& at,
                             P estimate, unsigned on, Ways& ways) {
  const Pack zero(0.0), above = time_above_crest(f, jet.state);
  const Pack step = safe_step(f, jet, error, at.guess);
  const Mask over = above > zero, stuck = !(step > Pack(4.0) * epsilon<Pack>() * at.p);
  const Pack reach = step * Pack(search_detail::kAhead);
  const Pack nearer = select(estimate > step, min(reach, estimate - step), reach);
  const Pack next_s = select(at.jumped, at.s, at.p + select(over, above, step));
  const Pack next_ahead = select(at.jumped, zero, select(over, search_detail::descent(f, at.guess), nearer));
  rows.store(kS, next_s, next_ahead);
  rows.store(kGuess, select(at.jumped || over, at.guess, step * Pack(2.0)), at.count + Pack(1.0));
  const unsigned alone = on & bits(stuck && !at.jumped && !over);
  ways.lanes[kAlone] |= alone;
  split(on & ~alone, f.is_small(next_s + next_ahead), kLookNear, kLookFar, ways);
}

// One evaluation of the search (find_impact).
template <Kind kKind>
AFM_LANE_INLINE Ways look(const Rows& rows) {
  const Flight<Pack> f = load_flight(rows);
  Look at;
  rows.load(kS, at.s, at.ahead);
  rows.load(kGuess, at.guess, at.count);
  const Pack p = at.p = at.s + at.ahead;
  const GapJet<Pack> jet = kKind == kLookNear ? f.gap_soon(p) : f.gap_by_turns(p);
  const Pack error = f.gap_error(p);
  at.jumped = at.ahead > Pack(0.0) && !positive_behind(f, jet, error, at.ahead);
  const auto in_front = [&] { return certify_root(f, jet, error); };
  const auto behind = [&] { return certify_root_behind(f, jet, error, at.ahead); };
  const RootInterval<Pack> root = either(at.jumped, behind, in_front);
  Ways ways;
  const unsigned beyond = bits(!(p < Pack(kSearchHorizon)) || at.count >= Pack(kMostEvaluations));
  const unsigned certain = bits(root.certain) & ~beyond, on = kAllLanes & ~(certain | beyond);
  ways.lanes[kAlone] = beyond;
  if (certain != 0) begin_root(rows, f, jet, p, root, certain, ways);
  if (on != 0) look_on(rows, f, jet, error, at, root.estimate, on, ways);
  return ways;
}

}  // namespace
}  // namespace afm
