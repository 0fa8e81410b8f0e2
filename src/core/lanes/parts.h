// The parts of a row: model, flight, search, root, impact.
#pragma once

#include "rows.h"

namespace afm {
namespace {

// How far the search has come, as in lane_tip.h.
struct Look {
  Pack s, ahead, guess, count;
};

// What is known of a certified root.
struct Root {
  GapJet<Pack> jet;              // near it
  Pack step;                     // from there to the root, as far as is known
  Pack low, high, s, t, is_end;  // as in lane_tip.h
};

// What a reflection asks for.
struct Incident {
  Pack phase, X, U, g1, h1;
  PackTime time;
};

AFM_LANE_INLINE void load_model(const Rows& rows, Mechanics<Pack>& m, Pack& eta) {
  rows.load(kRatio, m.ratio, m.omega_h);
  rows.load(kPerOmegaH, m.per_omega_h, m.H);
  rows.load(kCentre, m.y0, eta);
  m.omega_v = Pack(kTwoPi);
  m.per_omega_v = Pack(1.0 / kTwoPi);
}
AFM_LANE_INLINE void load_law(const Rows& rows, ReflectionLaw<Pack>& law, Pack& burst_gap_rate) {
  rows.load(kMobility, law.free, law.gamma);
  rows.load(kCutoff, law.v_c, burst_gap_rate);
}

AFM_LANE_INLINE void load_flight(const Rows& rows, GapJet<Pack>& o, FlightBounds<Pack>& b) {
  Pack u;
  rows.load(kPhase, o.state.phase, u);
  rows.load(kX, o.state.X, o.state.U);
  rows.load(kY, o.state.Y, o.state.W);
  rows.load(kG1, o.g1, o.g2);
  rows.load(kG3, o.g3, o.h);
  rows.load(kH1, o.h1, b.X);
  rows.load(kBoundY, b.Y, b.second);
  rows.load(kBound3, b.third, b.fourth);
  rows.load(kBoundDrive, b.drive, b.fastest);
}
// Of a flight that is no more evaluated from its start.
AFM_LANE_INLINE void load_bounds(const Rows& rows, GapJet<Pack>& o, FlightBounds<Pack>& b) {
  rows.load(kG1, o.g1, o.g2);
  rows.load(kBoundY, b.Y, b.second);
  rows.load(kBoundDrive, b.drive, b.fastest);
}
AFM_LANE_INLINE void store_flight(const Rows& rows, const Flight<Pack>& f, const PackTime& start) {
  const GapJet<Pack>& o = f.start();
  const FlightBounds<Pack>& b = f.bounds();
  rows.store(kPhase, o.state.phase, f.launch().u);
  rows.store(kX, o.state.X, o.state.U);
  rows.store(kY, o.state.Y, o.state.W);
  rows.store(kG1, o.g1, o.g2);
  rows.store(kG3, o.g3, o.h);
  rows.store(kH1, o.h1, b.X);
  rows.store(kBoundY, b.Y, b.second);
  rows.store(kBound3, b.third, b.fourth);
  rows.store(kBoundDrive, b.drive, b.fastest);
  rows.store(kStartTau, start.tau, start.phase);
}

AFM_LANE_INLINE void load_root(const Rows& rows, Root& root) {
  GapJet<Pack>& jet = root.jet;
  Pack unused;
  rows.load(kJetPhase, jet.state.phase, jet.state.X);
  rows.load(kJetRateX, jet.state.U, jet.state.Y);
  rows.load(kJetRateY, jet.state.W, jet.g);
  rows.load(kJetG1, jet.g1, jet.g2);
  rows.load(kJetG3, jet.g3, jet.h);
  rows.load(kJetH1, jet.h1, root.step);
  rows.load(kLow, root.low, root.high);
  rows.load(kJetS, root.s, root.t);
  rows.load(kIsEnd, root.is_end, unused);
}
AFM_LANE_INLINE void store_root(const Rows& rows, const Root& root) {
  const GapJet<Pack>& jet = root.jet;
  rows.store(kJetPhase, jet.state.phase, jet.state.X);
  rows.store(kJetRateX, jet.state.U, jet.state.Y);
  rows.store(kJetRateY, jet.state.W, jet.g);
  rows.store(kJetG1, jet.g1, jet.g2);
  rows.store(kJetG3, jet.g3, jet.h);
  rows.store(kJetH1, jet.h1, root.step);
  rows.store(kLow, root.low, root.high);
  rows.store(kJetS, root.s, root.t);
  rows.store(kIsEnd, root.is_end, Pack(0.0));
}

AFM_LANE_INLINE void load_incident(const Rows& rows, Incident& end) {
  Pack unused;
  rows.load(kEndSurface, end.phase, end.X);
  rows.load(kEndRateX, end.U, end.g1);
  rows.load(kEndH1, end.h1, unused);
  rows.load(kEndTau, end.time.tau, end.time.phase);
}
AFM_LANE_INLINE void store_incident(const Rows& rows, const Incident& end) {
  rows.store(kEndSurface, end.phase, end.X);
  rows.store(kEndRateX, end.U, end.g1);
  rows.store(kEndH1, end.h1, Pack(0.0));
  rows.store(kEndTau, end.time.tau, end.time.phase);
}

}  // namespace
}  // namespace afm
