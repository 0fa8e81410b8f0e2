// A pack in flight: what its tips' rows held and what has become of it. As long as all go one way nothing goes back to
// the rows: to put numbers side by side takes as long as a third of what is done with them.
#pragma once

#include "parts.h"

namespace afm {
namespace {

struct Live {
  LaneTip* const* tips;
  union {
    Flight<Pack> flight;  // no number of it is made ready before it is known
  };
  bool whole;  // it may be evaluated from its start
  Look look;
  Root root;
  Incident incident;
  PackTime start, limit;
  ReflectionLaw<Pack> law;
  Pack burst_gap_rate;

  // What of a row is newer here.
  enum Part : unsigned { kFlight = 1, kLook = 2, kRoot = 4, kIncident = 8 };
  unsigned newer = 0;

  // Of tips that wait for this now.
  Live(LaneTip* const* pack, Kind kind) : tips(pack) {
    const Rows rows(tips);
    const bool looks = kind == kLookNear || kind == kLookFar;
    Pack unused;
    load_flight(rows, kind, looks || kind == kFinishFar);
    if (looks) rows.load(kS, look.s, look.ahead);
    if (kind == kBounce) {
      incident_part(Load{rows}, incident, unused);
    } else {
      rows.load(kGuess, look.guess, look.count);
      if (!looks) root_part(Load{rows}, root, unused);
    }
  }

  void ask_for_law() {
    if (lawful_) return;
    load_law(Rows(tips), law, burst_gap_rate);
    lawful_ = true;
  }
  void ask_for_times() {
    if (timed_) return;
    const Rows rows(tips);
    if ((newer & kFlight) == 0) rows.load(kStartTau, start.tau, start.phase);
    rows.load(kLimitTau, limit.tau, limit.phase);
    timed_ = true;
  }

  void store() const {
    const Rows rows(tips);
    const Pack zero(0.0);
    if ((newer & kFlight) != 0) {
      flight_part(Store{rows}, flight.start(), flight.bounds(), flight.launch().u);
      rows.store(kStartTau, start.tau, start.phase);
    }
    if ((newer & kLook) != 0) rows.store(kS, look.s, look.ahead);
    if ((newer & (kLook | kRoot)) != 0) rows.store(kGuess, look.guess, look.count);
    if ((newer & kRoot) != 0) root_part(Store{rows}, root, zero);
    if ((newer & kIncident) != 0) incident_part(Store{rows}, incident, zero);
  }

 private:
  AFM_LANE_INLINE void load_flight(const Rows& rows, Kind kind, bool all) {
    Mechanics<Pack> m;
    Pack eta, u;
    load_model(rows, m, eta);
    GapJet<Pack> o{};
    FlightBounds<Pack> b{};
    if (all) {
      flight_part(Load{rows}, o, b, u);
    } else if (kind != kBounce) {
      load_bounds(rows, o, b);
    }
    flight = Flight<Pack>(m, eta, o, b);
    whole = all;
  }

  bool timed_ = false, lawful_ = false;
};

}  // namespace
}  // namespace afm
