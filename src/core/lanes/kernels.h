// What is done to a pack of tips at one stage of their flights. Each says what comes next for each lane.
#pragma once

#include <cstddef>

#include "lane_tip.h"
#include "pack.h"

namespace afm {
namespace {

using lanes::LaneTip;
using namespace lanes;  // the fields

constexpr double kHorizon = 8.0;          // [tau] of the search, as tip.cpp has it
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
  rows.load(kBoundDrive, b.drive, b.small_until);
  return Flight<Pack>(m, eta, start, b);
}

AFM_LANE_INLINE void store_jet(const Rows& rows, const GapJet<Pack>& jet, P step) {
  rows.store(kJetPhase, jet.state.phase, jet.state.X);
  rows.store(kJetRateX, jet.state.U, jet.state.Y);
  rows.store(kJetRateY, jet.state.W, jet.g);
  rows.store(kJetG1, jet.g1, jet.g2);
  rows.store(kJetG3, jet.g3, jet.h);
  rows.store(kJetH1, jet.h1, step);
}

AFM_LANE_INLINE void split(unsigned lanes, M first, Kind yes, Kind no, Ways& ways) {
  ways.lanes[yes] |= lanes & bits(first);
  ways.lanes[no] |= lanes & ~bits(first);
}

// Which evaluation gap_near would choose for a step from the time s.
AFM_LANE_INLINE void split_by_step(unsigned lanes, const Flight<Pack>& f, P s, P step, Ways& ways) {
  const Pack until = f.bounds().small_until, size = abs(step);
  const unsigned start = bits(s + step <= until), tiny = bits(size <= until / Pack(128.0)), near = bits(size <= until);
  ways.lanes[kFinishTiny] |= lanes & tiny & ~start;
  ways.lanes[kFinishNear] |= lanes & near & ~tiny & ~start;
  ways.lanes[kFinishFar] |= lanes & (start | ~near);
}

// One evaluation of the search (find_impact).
template <Kind kKind>
AFM_LANE_INLINE Ways look(const Rows& rows) {
  const Flight<Pack> f = load_flight(rows);
  const Pack zero(0.0);
  Pack s, ahead, guess, count;
  rows.load(kS, s, ahead);
  rows.load(kGuess, guess, count);
  const Pack p = s + ahead;
  const GapJet<Pack> jet = kKind == kLookNear ? f.gap_by_small_turns(p) : f.gap_by_turns(p);
  const Pack error = f.gap_error(p);
  const Mask jumped = ahead > zero && !positive_behind(f, jet, error, ahead);
  const auto in_front = [&] { return certify_root(f, jet, error); };
  const auto behind = [&] { return certify_root_behind(f, jet, error, ahead); };
  const RootInterval<Pack> root = either(jumped, behind, in_front);
  Ways ways;
  const unsigned beyond = bits(!(p < Pack(kHorizon)) || count >= Pack(kMostEvaluations));
  const unsigned certain = bits(root.certain) & ~beyond;
  ways.lanes[kAlone] = beyond;
  if (certain != 0) {
    store_jet(rows, jet, root.estimate);
    rows.store(kLow, root.low, root.high);
    rows.store(kJetS, p, zero);
    rows.store(kIsEnd, zero, zero);
    const unsigned here = certain & bits(search_detail::settles(f, jet, root.estimate, p));
    ways.lanes[kFinishHere] = here;
    split_by_step(certain & ~here, f, p, root.estimate, ways);
  }
  const unsigned on = kAllLanes & ~(certain | beyond);
  if (on != 0) {
    const Pack above = time_above_crest(f, jet.state);
    const Pack step = safe_step(f, jet, error, guess);
    const Mask over = above > zero, stuck = !(step > Pack(4.0) * epsilon<Pack>() * p);
    const Pack reach = step * Pack(search_detail::kAhead);
    const Pack nearer = select(root.estimate > step, min(reach, root.estimate - step), reach);
    const Pack next_s = select(jumped, s, p + select(over, above, step));
    const Pack next_ahead = select(jumped, zero, select(over, search_detail::descent(f, guess), nearer));
    rows.store(kS, next_s, next_ahead);
    rows.store(kGuess, select(jumped || over, guess, step * Pack(2.0)), count + Pack(1.0));
    const unsigned alone = on & bits(stuck && !jumped && !over);
    ways.lanes[kAlone] |= alone;
    split(on & ~alone, next_s + next_ahead <= f.bounds().small_until, kLookNear, kLookFar, ways);
  }
  return ways;
}

template <Kind kKind>
AFM_LANE_INLINE GapJet<Pack> stepped(const Flight<Pack>& f, const GapJet<Pack>& jet, P s, P step) {
  if (kKind == kFinishTiny) return f.moved_by_tiny_turns(jet, step);
  if (kKind == kFinishNear) return f.moved_by_small_turns(jet, step);
  return f.gap(s + step);
}

// One evaluation of what is left of a certified root (search_detail::finish); when it is found, the time.
template <Kind kKind>
AFM_LANE_INLINE Ways finish(const Rows& rows) {
  const Flight<Pack> f = load_flight(rows);
  GapJet<Pack> jet;
  Pack step, low, high, s, t, is_end, unused, guess, count;
  rows.load(kJetPhase, jet.state.phase, jet.state.X);
  rows.load(kJetRateX, jet.state.U, jet.state.Y);
  rows.load(kJetRateY, jet.state.W, jet.g);
  rows.load(kJetG1, jet.g1, jet.g2);
  rows.load(kJetG3, jet.g3, jet.h);
  rows.load(kJetH1, jet.h1, step);
  rows.load(kLow, low, high);
  rows.load(kJetS, s, t);
  rows.load(kIsEnd, is_end, unused);
  rows.load(kGuess, guess, count);
  if (kKind != kFinishHere) {
    jet = stepped<kKind>(f, jet, s + t, step);
    t = t + step;
  }
  const Mask end = is_end > Pack(0.0);
  step = root_step(jet);
  const Pack to = t + step;
  step = select(to < low || high < to, clamp(to, low, high) - t, step);
  const Pack at = s + t, bend = Pack(4.0) * f.fourth_derivative_bound() * abs(step * step * step);
  const Mask smooth = bend <= epsilon<Pack>() * abs(jet.g1), settled = search_detail::settles(f, jet, step, at);
  const Mask hidden = abs(step * jet.g1) <= f.gap_error(at), drifts = (hidden || (smooth && settled)) && !end;
  Ways ways;
  const unsigned done = bits(drifts || end), on = kAllLanes & ~done;
  if (on != 0) {
    store_jet(rows, jet, step);
    rows.store(kJetS, s, t);
    rows.store(kIsEnd, select(settled, Pack(1.0), Pack(0.0)), unused);
    rows.store(kGuess, guess, count + Pack(1.0));
    const unsigned many = on & bits(count >= Pack(kMostEvaluations));
    ways.lanes[kAlone] = many;
    split_by_step(on & ~many, f, at, step, ways);
  }
  if (done != 0) {
    const GapJet<Pack> moved = drift(f, jet, step);
    const Pack end_s = s + select(end, t, t + step), g1 = select(end, jet.g1, moved.g1);
    PackTime start, limit;
    rows.load(kStartTau, start.tau, start.phase);
    rows.load(kLimitTau, limit.tau, limit.phase);
    const PackTime time = start + end_s;
    if (on == 0) {
      rows.store(kJetPhase, select(end, jet.state.phase, moved.state.phase), select(end, jet.state.X, moved.state.X));
      rows.store(kJetRateX, select(end, jet.state.U, moved.state.U), g1);
    } else {
      const Mask stay = !(drifts || end);
      rows.store(kJetPhase, select(drifts, moved.state.phase, jet.state.phase),
                 select(drifts, moved.state.X, jet.state.X));
      rows.store(kJetRateX, select(drifts, moved.state.U, jet.state.U), select(stay, jet.state.Y, g1));
    }
    rows.store(kEndTau, time.tau, time.phase);
    const unsigned rising = done & bits(!(g1 < Pack(0.0))), late = done & ~rising & bits(limit < time);
    ways.lanes[kAlone] |= rising;
    ways.lanes[kLimited] = late;
    ways.lanes[kBounce] = done & ~rising & ~late;
  }
  return ways;
}

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
  Pack eta, burst, g1;
  load_model(rows, m, eta);
  ReflectionLaw<Pack> law;
  law.H = m.H;
  rows.load(kMobility, law.free, law.gamma);
  rows.load(kCutoff, law.v_c, burst);
  FlightState<Pack> incident{};
  rows.load(kJetPhase, incident.phase, incident.X);
  rows.load(kJetRateX, incident.U, g1);
  PackTime time;
  rows.load(kEndTau, time.tau, time.phase);
  const ReflectionOf<Pack> r = reflect(law, eta, incident, g1);
  log(tips, time, r);
  const Flight<Pack> f(m, eta, r.after, r.surface);
  const GapJet<Pack>& o = f.start();
  const FlightBounds<Pack>& b = f.bounds();
  Pack s, ahead, guess;
  search_detail::take_off(f, s, ahead, guess);
  rows.store(kPhase, o.state.phase, r.after.u);
  rows.store(kX, o.state.X, o.state.U);
  rows.store(kY, o.state.Y, o.state.W);
  rows.store(kG1, o.g1, o.g2);
  rows.store(kG3, o.g3, o.h);
  rows.store(kH1, o.h1, b.X);
  rows.store(kBoundY, b.Y, b.second);
  rows.store(kBound3, b.third, b.fourth);
  rows.store(kBoundDrive, b.drive, b.small_until);
  rows.store(kS, s, ahead);
  rows.store(kGuess, guess, Pack(0.0));
  rows.store(kStartTau, time.tau, time.phase);
  const Pack zero(0.0);
  const Mask brief = search_detail::is_brief(f, search_detail::parabola_length(f));
  const Mask ordinary = o.g1 > Pack(kSlowestLaunch) && !(o.g2 < zero && o.g1 <= burst) && !brief;
  Ways ways;
  split(bits(ordinary), s + ahead <= b.small_until, kLookNear, kLookFar, ways);
  ways.lanes[kAlone] = kAllLanes & ~bits(ordinary);
  return ways;
}

}  // namespace
}  // namespace afm
