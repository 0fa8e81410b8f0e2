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

// Each names its fields once, to be loaded or stored.
template <class Pairs, class Jet, class Bounds, class U>
AFM_LANE_INLINE void flight_part(const Pairs& pairs, Jet& o, Bounds& b, U& u) {
  pairs(kPhase, o.state.phase, u);
  pairs(kX, o.state.X, o.state.U);
  pairs(kY, o.state.Y, o.state.W);
  pairs(kG1, o.g1, o.g2);
  pairs(kG3, o.g3, o.h);
  pairs(kH1, o.h1, b.X);
  pairs(kBoundY, b.Y, b.second);
  pairs(kBound3, b.third, b.fourth);
  pairs(kBoundDrive, b.drive, b.fastest);
}
// Of a flight that is no more evaluated from its start.
AFM_LANE_INLINE void load_bounds(const Rows& rows, GapJet<Pack>& o, FlightBounds<Pack>& b) {
  rows.load(kG1, o.g1, o.g2);
  rows.load(kBoundY, b.Y, b.second);
  rows.load(kBoundDrive, b.drive, b.fastest);
}
template <class Pairs, class R, class Unused>
AFM_LANE_INLINE void root_part(const Pairs& pairs, R& root, Unused& unused) {
  auto& jet = root.jet;
  pairs(kJetPhase, jet.state.phase, jet.state.X);
  pairs(kJetRateX, jet.state.U, jet.state.Y);
  pairs(kJetRateY, jet.state.W, jet.g);
  pairs(kJetG1, jet.g1, jet.g2);
  pairs(kJetG3, jet.g3, jet.h);
  pairs(kJetH1, jet.h1, root.step);
  pairs(kLow, root.low, root.high);
  pairs(kJetS, root.s, root.t);
  pairs(kIsEnd, root.is_end, unused);
}
template <class Pairs, class I, class Unused>
AFM_LANE_INLINE void incident_part(const Pairs& pairs, I& end, Unused& unused) {
  pairs(kEndSurface, end.phase, end.X);
  pairs(kEndRateX, end.U, end.g1);
  pairs(kEndH1, end.h1, unused);
  pairs(kEndTau, end.time.tau, end.time.phase);
}

}  // namespace
}  // namespace afm
