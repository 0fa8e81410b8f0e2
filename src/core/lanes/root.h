// The way from a look that has certified a root to the root itself.
#pragma once

#include "core/tip/tip_arcs.h"
#include "live.h"

namespace afm {
namespace {

AFM_LANE_INLINE void hold_root(Live& live, const GapJet<Pack>& jet, P s, const RootInterval<Pack>& root) {
  const Pack zero(0.0);
  live.root = {jet, root.estimate, root.low, root.high, s, zero, zero};
  live.newer |= Live::kRoot;
}

// Which evaluation gap_near would choose for a step from the time s.
AFM_LANE_INLINE void split_by_step(unsigned lanes, const Flight<Pack>& f, P s, P step, Ways& ways) {
  const Pack size = abs(step);
  const unsigned start = bits(f.is_small(s + step)), tiny = bits(f.is_tiny(size)), near = bits(f.is_small(size));
  ways.lanes[kFinishTiny] |= lanes & tiny & ~start;
  ways.lanes[kFinishNear] |= lanes & near & ~tiny & ~start;
  ways.lanes[kFinishFar] |= lanes & (start | ~near);
}

template <Kind kKind>
AFM_LANE_INLINE GapJet<Pack> stepped(const Flight<Pack>& f, const GapJet<Pack>& jet, P s, P step) {
  if (kKind == kFinishTiny) return f.moved_by_tiny_turns(jet, step);
  if (kKind == kFinishNear) return f.moved_by_small_turns(jet, step);
  return f.gap(s + step);
}

// Those that need another evaluation.
AFM_LANE_INLINE void go_on(Live& live, unsigned on, M settled, Ways& ways) {
  Root& root = live.root;
  root.is_end = select(settled, Pack(1.0), Pack(0.0));
  live.look.count = live.look.count + Pack(1.0);
  live.newer |= Live::kRoot;
  const unsigned many = on & bits(live.look.count > Pack(kMostEvaluations));
  ways.lanes[kAlone] = many;
  split_by_step(on & ~many, live.flight, root.s + root.t, root.step, ways);
}

// Those that are there: what a reflection asks for, when, and whether the limit comes first.
AFM_LANE_INLINE void arrive(Live& live, const GapJet<Pack>& moved, unsigned done, M end, Ways& ways) {
  live.ask_for_times();
  const Root& root = live.root;
  const GapJet<Pack>& jet = root.jet;
  const Pack end_s = root.s + select(end, root.t, root.t + root.step), g1 = select(end, jet.g1, moved.g1);
  const PackTime time = live.start + end_s;
  live.incident = {select(end, jet.state.phase, moved.state.phase),
                   select(end, jet.state.X, moved.state.X),
                   select(end, jet.state.U, moved.state.U),
                   g1,
                   select(end, jet.h1, moved.h1),
                   time};
  live.newer |= Live::kIncident;
  const unsigned alone = done & bits(!(g1 < Pack(0.0)) || end_s < Pack(kLeastFlight));
  const unsigned late = done & ~alone & bits(live.limit < time);
  ways.lanes[kAlone] |= alone;
  ways.lanes[kLimited] = late;
  ways.lanes[kBounce] = done & ~alone & ~late;
}

// One evaluation of what is left of a certified root (search_detail::finish).
template <Kind kKind>
AFM_LANE_INLINE Ways finish(Live& live) {
  const Flight<Pack>& f = live.flight;
  live.newer &= Live::kFlight;
  Root& root = live.root;
  GapJet<Pack>& jet = root.jet;
  Pack &step = root.step, &t = root.t;
  const Pack zero(0.0);
  const Mask first = !(root.s > zero) && !(t > zero);  // at the end of a brief bounce
  if (kKind != kFinishHere) {
    jet = stepped<kKind>(f, jet, root.s + t, step);
    t = t + step;
  }
  const Mask end = root.is_end > Pack(0.0);
  const Pack at = root.s + t;
  const NearJet<Pack> near(f, jet);
  const ShortStep<Pack> rest = short_step(f, near, at);
  const Mask brief = first && rest.enough && lies_within(root.low, t + rest.step, root.high);
  step = root_step(near);
  const Pack to = t + step;
  const Mask above = jet.g > Pack(0.0);
  root.low = select(above, t, root.low), root.high = select(above, root.high, t);
  step = select(lies_within(root.low, to, root.high), step, (root.low + root.high) * Pack(0.5) - t);
  const bool some = kKind == kFinishFar && bits(first) != 0;  // may have come shortly
  if (some) step = select(brief, rest.step, step);
  const Mask settled = kKind == kFinishHere ? at <= at : search_detail::settles(f, near, step, at);
  const Mask hidden = abs(step * jet.g1) <= f.gap_error(at);
  const Mask near_by = hidden || (settled && search_detail::is_smooth(f, jet, step));
  const Mask drifts = (some ? brief || near_by : near_by) && !end;
  const unsigned hides = kKind == kFinishHere ? 0u : bits(!(jet.g1 < Pack(0.0))) & ~bits(end);
  Ways ways;
  const unsigned done = bits(drifts || end) & ~hides, on = kAllLanes & ~(done | hides);
  if (on != 0) go_on(live, on, settled, ways);
  const auto in_full = [&] { return drift(f, near, step); };
  const auto shortly = [&] { return short_drift(f, jet, step); };
  if (done != 0) arrive(live, some ? either(brief, shortly, in_full) : in_full(), done, end, ways);
  ways.lanes[kAlone] |= hides;
  return ways;
}

}  // namespace
}  // namespace afm
