// A look of the search: is there a root near, and where is the next look?
#pragma once

#include "root.h"

namespace afm {
namespace {

// Those that have certified a root.
AFM_LANE_INLINE void begin_root(Live& live, const GapJet<Pack>& jet, P p, const RootInterval<Pack>& root,
                                unsigned certain, Ways& ways) {
  hold_root(live, jet, p, root);
  const unsigned here = certain & bits(search_detail::is_there(live.flight, jet, root, p));
  ways.lanes[kFinishHere] = here;
  split_by_step(certain & ~here, live.flight, p, root.estimate, ways);
}

// Those that have not: where they look next. `p`: where this look was; `jumped`: over what it does not certify.
AFM_LANE_INLINE void look_on(Live& live, const GapJet<Pack>& jet, P error, P p, M jumped, P estimate, unsigned on,
                             Ways& ways) {
  const Flight<Pack>& f = live.flight;
  Look& at = live.look;
  const Pack zero(0.0), above = time_above_crest(f, jet.state);
  const Pack step = safe_step(f, jet, error, at.guess);
  const Mask over = above > zero, stuck = !(step > Pack(4.0) * epsilon<Pack>() * p);
  const Pack reach = step * Pack(search_detail::kAhead);
  const Pack nearer = select(estimate > step, min(reach, estimate - step), reach);
  at.s = select(jumped, at.s, p + select(over, above, step));
  at.ahead = select(jumped, zero, select(over, search_detail::descent(f, at.guess), nearer));
  at.guess = select(jumped || over, at.guess, step * Pack(2.0));
  at.count = at.count + Pack(1.0);
  live.newer |= Live::kLook;
  const unsigned alone = on & bits(stuck && !jumped && !over);
  ways.lanes[kAlone] |= alone;
  split(on & ~alone, f.is_small(at.s + at.ahead), kLookNear, kLookFar, ways);
}

// One evaluation of the search (find_impact).
template <Kind kKind>
AFM_LANE_INLINE Ways look(Live& live) {
  const Flight<Pack>& f = live.flight;
  live.newer &= Live::kFlight;
  const Look& at = live.look;
  const Pack p = at.s + at.ahead;
  const GapJet<Pack> jet = kKind == kLookNear ? f.gap_soon(p) : f.gap_by_turns(p);
  const Pack error = f.gap_error(p);
  const Mask jumped = at.ahead > Pack(0.0) && !positive_behind(f, jet, error, at.ahead);
  const auto in_front = [&] { return certify_root(f, jet, error); };
  const auto behind = [&] { return certify_root_behind(f, jet, error, at.ahead); };
  const RootInterval<Pack> root = either(jumped, behind, in_front);
  Ways ways;
  const unsigned beyond = bits(!(p < Pack(kSearchHorizon)) || at.count >= Pack(kMostEvaluations));
  const unsigned certain = bits(root.certain) & ~beyond, on = kAllLanes & ~(certain | beyond);
  ways.lanes[kAlone] = beyond;
  if (certain != 0) begin_root(live, jet, p, root, certain, ways);
  if (on != 0) look_on(live, jet, error, p, jumped, root.estimate, on, ways);
  return ways;
}

}  // namespace
}  // namespace afm
