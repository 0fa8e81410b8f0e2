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
    load_flight(rows, kind, looks || kind == kFinishFar);
    if (looks) rows.load(kS, look.s, look.ahead);
    if (kind == kBounce) {
      load_incident(rows, incident);
    } else {
      rows.load(kGuess, look.guess, look.count);
      if (!looks) load_root(rows, root);
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
    if ((newer & kFlight) != 0) store_flight(rows, flight, start);
    if ((newer & kLook) != 0) rows.store(kS, look.s, look.ahead);
    if ((newer & (kLook | kRoot)) != 0) rows.store(kGuess, look.guess, look.count);
    if ((newer & kRoot) != 0) store_root(rows, root);
    if ((newer & kIncident) != 0) store_incident(rows, incident);
  }

 private:
  AFM_LANE_INLINE void load_flight(const Rows& rows, Kind kind, bool all) {
    Mechanics<Pack> m;
    Pack eta;
    load_model(rows, m, eta);
    GapJet<Pack> o{};
    FlightBounds<Pack> b{};
    if (all) {
      afm::load_flight(rows, o, b);
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
