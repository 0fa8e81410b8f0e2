// What is done to a pack of tips at one stage of their flights. Each says what comes next for each lane.
#pragma once

#include <cstddef>

#include "lane_tip.h"
#include "pack.h"

namespace afm {
namespace {

using lanes::LaneTip;
using namespace lanes;  // the fields

constexpr double kHorizon = 8.0;  // [tau] of the search, as tip.cpp has it
constexpr int kMaxLooks = 200;    // more are a tip's own affair
constexpr int kMaxFinish = 8;     // likewise

// The rows of the tips in a pack.
struct Rows {
  double* row[kLanes];

  explicit AFM_LANE_INLINE Rows(LaneTip* const* tips) {
    for (int i = 0; i < kLanes; ++i) row[i] = tips[i]->row;
  }
  AFM_LANE_INLINE void load(int at, Pack& first, Pack& second) const {
    for (int k = 0; k < kRegisters; ++k) load_pair(row + k * kRegisterLanes, at, first.r[k], second.r[k]);
  }
  AFM_LANE_INLINE void store(int at, P first, P second) const {
    for (int k = 0; k < kRegisters; ++k) store_pair(row + k * kRegisterLanes, at, first.r[k], second.r[k]);
  }
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

AFM_LANE_INLINE void store_jet(const Rows& rows, const GapJet<Pack>& jet, const RootInterval<Pack>& root, P s) {
  rows.store(kJetPhase, jet.state.phase, jet.state.X);
  rows.store(kJetRateX, jet.state.U, jet.state.Y);
  rows.store(kJetRateY, jet.state.W, jet.g);
  rows.store(kJetG1, jet.g1, jet.g2);
  rows.store(kJetG3, jet.g3, jet.h);
  rows.store(kJetH1, jet.h1, root.estimate);
  rows.store(kLow, root.low, root.high);
  rows.store(kJetS, s, s);
}

// Lanes that go on to a stage; the others stay.
struct Next {
  unsigned on, single;
};

// One evaluation of the search (find_impact).
AFM_LANE_INLINE Next look(LaneTip* const* tips) {
  const Rows rows(tips);
  const Flight<Pack> f = load_flight(rows);
  const Pack zero(0.0), horizon(kHorizon);
  Pack s, ahead, guess, burst;
  rows.load(kS, s, ahead);
  rows.load(kGuess, guess, burst);
  const Pack p = s + ahead;
  const Mask beyond = !(p < horizon);
  const GapJet<Pack> jet = f.gap(p);
  const Pack error = f.gap_error(p);
  const Mask jumped = ahead > zero && !positive_behind(f, jet, error, ahead);
  const auto in_front = [&] { return certify_root(f, jet, error); };
  const auto behind = [&] { return certify_root_behind(f, jet, error, ahead); };
  const RootInterval<Pack> root = either(jumped, behind, in_front);
  const unsigned certain = bits(root.certain && !beyond);
  if (certain != 0) store_jet(rows, jet, root, p);
  unsigned single = bits(beyond);
  if ((certain | single) != kAllLanes) {
    const Pack above = time_above_crest(f, jet.state);
    const Pack step = safe_step(f, jet, error, guess);
    const Mask over = above > zero, stuck = !(step > Pack(4.0) * epsilon<Pack>() * p);
    const Pack reach = step * Pack(search_detail::kAhead);
    const Pack nearer = select(root.estimate > step, min(reach, root.estimate - step), reach);
    const Pack next_s = select(over, p + above, p + step);
    const Pack next_ahead = select(over, search_detail::descent(f, guess), nearer);
    rows.store(kS, select(jumped, s, next_s), select(jumped, zero, next_ahead));
    rows.store(kGuess, select(jumped || over, guess, step * Pack(2.0)), burst);
    single |= bits(stuck && !jumped && !over) & ~certain;
  }
  return {certain, single};
}

// What is left of a certified root (search_detail::finish), and when it is.
AFM_LANE_INLINE Next finish(LaneTip* const* tips, const PackTime& limit, unsigned& limited) {
  const Rows rows(tips);
  const Flight<Pack> f = load_flight(rows);
  GapJet<Pack> jet;
  Pack step, low, high, s, s_again;
  rows.load(kJetPhase, jet.state.phase, jet.state.X);
  rows.load(kJetRateX, jet.state.U, jet.state.Y);
  rows.load(kJetRateY, jet.state.W, jet.g);
  rows.load(kJetG1, jet.g1, jet.g2);
  rows.load(kJetG3, jet.g3, jet.h);
  rows.load(kJetH1, jet.h1, step);
  rows.load(kLow, low, high);
  rows.load(kJetS, s, s_again);
  Pack t(0.0), end_s(0.0);
  GapJet<Pack> end = jet;
  const Mask none = Pack(1.0) < Pack(0.0);
  Mask done = none, there = search_detail::settles(f, jet, step, s);
  for (int i = 0; i < kMaxFinish && bits(done) != kAllLanes; ++i) {
    jet = either(
        there, [&] { return jet; }, [&] { return f.gap_near(jet, s + t, step); });
    t = select(there, t, t + step);
    there = none;
    step = root_step(jet);
    const Pack to = t + step;
    step = select(to < low || high < to, clamp(to, low, high) - t, step);
    const Mask smooth =
        Pack(4.0) * f.fourth_derivative_bound() * abs(step * step * step) <= epsilon<Pack>() * abs(jet.g1);
    const Mask settled = search_detail::settles(f, jet, step, s + t);
    const Mask hidden = abs(step * jet.g1) <= f.gap_error(s + t);
    const Mask drifts = hidden || (smooth && settled);
    const Mask now = (drifts || settled) && !done;
    if (!any(now)) continue;
    const GapJet<Pack> found = either(
        drifts, [&] { return drift(f, jet, step); },
        [&] {
          return either(
              settled, [&] { return f.gap_near(jet, s + t, step); }, [&] { return jet; });
        });
    end = select(now, found, end);
    end_s = select(now, s + (t + step), end_s);
    done = done || now;
  }
  PackTime start;
  rows.load(kStartTau, start.tau, start.phase);
  const PackTime time = start + end_s;
  const Mask falling = end.g1 < Pack(0.0);
  const unsigned found = bits(done && falling);
  rows.store(kJetPhase, end.state.phase, end.state.X);
  rows.store(kJetRateX, end.state.U, end.g1);
  rows.store(kEndTau, time.tau, time.phase);
  limited = bits(limit < time) & found;
  return {found & ~limited, ~found & kAllLanes};
}

// An impact's record is a row too.
static_assert(sizeof(Impact) == 56 && offsetof(Impact, time) == 0 && offsetof(Impact, surface_phase) == 16 &&
                  offsetof(Impact, normal_speed) == 24 && offsetof(Impact, tangential_velocity) == 32 &&
                  offsetof(Impact, energy_loss) == 40 && offsetof(Impact, kind) == 48 && offsetof(Impact, count) == 52,
              "the record of an impact is stored by pairs of numbers");

AFM_LANE_INLINE void log(LaneTip* const* tips, const PackTime& time, const ReflectionOf<Pack>& r) {
  double* row[kLanes];
  for (int i = 0; i < kLanes; ++i) row[i] = reinterpret_cast<double*>(&tips[i]->last);
  for (int k = 0; k < kRegisters; ++k) {
    double* const* rows = row + k * kRegisterLanes;
    store_pair(rows, 0, time.tau.r[k], time.phase.r[k]);
    store_pair(rows, 2, r.after.phase.r[k], r.normal_speed.r[k]);
    store_pair(rows, 4, r.tangential_velocity.r[k], r.energy_loss.r[k]);
  }
  for (int i = 0; i < kLanes; ++i) {
    tips[i]->last.kind = ImpactKind::impact;
    tips[i]->last.count = 1;
  }
}

// The reflection, its record, and the flight that it begins (Tip::land and take_off).
AFM_LANE_INLINE Next bounce(LaneTip* const* tips) {
  const Rows rows(tips);
  Mechanics<Pack> m;
  Pack eta, unused, g1;
  load_model(rows, m, eta);
  ReflectionLaw<Pack> law;
  law.H = m.H;
  rows.load(kMobility, law.free, law.gamma);
  rows.load(kCutoff, law.v_c, unused);
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
  Pack s, ahead, guess, burst;
  rows.load(kGuess, guess, burst);
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
  rows.store(kGuess, guess, burst);
  rows.store(kStartTau, time.tau, time.phase);
  const Pack zero(0.0);
  const Mask ordinary = o.g1 > zero && !(o.g2 < zero && o.g1 <= burst);
  return {bits(ordinary), ~bits(ordinary) & kAllLanes};
}

}  // namespace
}  // namespace afm
