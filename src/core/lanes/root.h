// The way from a look that has certified a root to the root itself.
#pragma once

#include "rows.h"

namespace afm {
namespace {

AFM_LANE_INLINE void store_jet(const Rows& rows, const GapJet<Pack>& jet, P step) {
  rows.store(kJetPhase, jet.state.phase, jet.state.X);
  rows.store(kJetRateX, jet.state.U, jet.state.Y);
  rows.store(kJetRateY, jet.state.W, jet.g);
  rows.store(kJetG1, jet.g1, jet.g2);
  rows.store(kJetG3, jet.g3, jet.h);
  rows.store(kJetH1, jet.h1, step);
}

AFM_LANE_INLINE void store_root(const Rows& rows, const GapJet<Pack>& jet, P s, const RootInterval<Pack>& root) {
  const Pack zero(0.0);
  store_jet(rows, jet, root.estimate);
  rows.store(kLow, root.low, root.high);
  rows.store(kJetS, s, zero);
  rows.store(kIsEnd, zero, zero);
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

// What is known of a certified root.
struct Root {
  GapJet<Pack> jet;      // near it
  Pack step;             // from there to the root, as far as is known
  Pack low, high, s, t;  // as in lane_tip.h
  Pack is_end, unused, guess, count;
};

AFM_LANE_INLINE void load_root(const Rows& rows, Root& root) {
  GapJet<Pack>& jet = root.jet;
  rows.load(kJetPhase, jet.state.phase, jet.state.X);
  rows.load(kJetRateX, jet.state.U, jet.state.Y);
  rows.load(kJetRateY, jet.state.W, jet.g);
  rows.load(kJetG1, jet.g1, jet.g2);
  rows.load(kJetG3, jet.g3, jet.h);
  rows.load(kJetH1, jet.h1, root.step);
  rows.load(kLow, root.low, root.high);
  rows.load(kJetS, root.s, root.t);
  rows.load(kIsEnd, root.is_end, root.unused);
  rows.load(kGuess, root.guess, root.count);
}

// Those that need another evaluation.
AFM_LANE_INLINE void go_on(const Rows& rows, const Flight<Pack>& f, const Root& root, unsigned on, M settled,
                           Ways& ways) {
  store_jet(rows, root.jet, root.step);
  rows.store(kLow, root.low, root.high);
  rows.store(kJetS, root.s, root.t);
  rows.store(kIsEnd, select(settled, Pack(1.0), Pack(0.0)), root.unused);
  rows.store(kGuess, root.guess, root.count + Pack(1.0));
  const unsigned many = on & bits(root.count >= Pack(kMostEvaluations));
  ways.lanes[kAlone] = many;
  split_by_step(on & ~many, f, root.s + root.t, root.step, ways);
}

// What a reflection asks for (`bounce`): of those that drift there by what is left of the step, of those that are at
// their end, and of the others what was in its place.
AFM_LANE_INLINE void store_incident(const Rows& rows, const GapJet<Pack>& jet, const GapJet<Pack>& moved, P g1,
                                    M drifts, M end, bool all) {
  const Pack h1 = select(end, jet.h1, moved.h1);
  if (all) {
    rows.store(kJetPhase, select(end, jet.state.phase, moved.state.phase), select(end, jet.state.X, moved.state.X));
    rows.store(kJetRateX, select(end, jet.state.U, moved.state.U), g1);
    rows.store(kJetRateY, h1, jet.g);
  } else {
    const Mask stay = !(drifts || end);
    rows.store(kJetPhase, select(drifts, moved.state.phase, jet.state.phase),
               select(drifts, moved.state.X, jet.state.X));
    rows.store(kJetRateX, select(drifts, moved.state.U, jet.state.U), select(stay, jet.state.Y, g1));
    rows.store(kJetRateY, select(stay, jet.state.W, h1), jet.g);
  }
}

// Those that are there: state and time, and whether the limit comes first.
AFM_LANE_INLINE void arrive(const Rows& rows, const Root& root, const GapJet<Pack>& moved, unsigned done, M drifts,
                            M end, Ways& ways) {
  const Pack end_s = root.s + select(end, root.t, root.t + root.step), g1 = select(end, root.jet.g1, moved.g1);
  PackTime start, limit;
  rows.load(kStartTau, start.tau, start.phase);
  rows.load(kLimitTau, limit.tau, limit.phase);
  const PackTime time = start + end_s;
  store_incident(rows, root.jet, moved, g1, drifts, end, done == kAllLanes);
  rows.store(kEndTau, time.tau, time.phase);
  const unsigned alone = done & bits(!(g1 < Pack(0.0)) || end_s < Pack(kLeastFlight));
  const unsigned late = done & ~alone & bits(limit < time);
  ways.lanes[kAlone] |= alone;
  ways.lanes[kLimited] = late;
  ways.lanes[kBounce] = done & ~alone & ~late;
}

// One evaluation of what is left of a certified root (search_detail::finish).
template <Kind kKind>
AFM_LANE_INLINE Ways finish(const Rows& rows) {
  const Flight<Pack> f = load_flight(rows);
  Root root;
  load_root(rows, root);
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
  if (on != 0) go_on(rows, f, root, on, settled, ways);
  const auto in_full = [&] { return drift(f, near, step); };
  const auto shortly = [&] { return short_drift(f, jet, step); };
  if (done != 0) arrive(rows, root, some ? either(brief, shortly, in_full) : in_full(), done, drifts, end, ways);
  ways.lanes[kAlone] |= hides;
  return ways;
}

}  // namespace
}  // namespace afm
