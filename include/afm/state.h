// Model time, the state of the tip (paper, section IV), and the record of one impact. Natural units: a, tau, tip mass
// m.
#pragma once

#include <cmath>
#include <cstdint>

namespace afm {

// A time in whole tau and a phase in [0, 1): its resolution does not depend on the length of the run.
struct ModelTime {
  std::int64_t tau = 0;
  double phase = 0.0;
};

inline ModelTime operator+(const ModelTime& t, double dt) {
  const double sum = t.phase + dt;
  const double whole = std::floor(sum);
  const double phase = sum - whole;
  // a sum just below a whole number can round up to it
  const bool carried = phase >= 1.0;
  return {t.tau + static_cast<std::int64_t>(whole) + (carried ? 1 : 0), carried ? 0.0 : phase};
}

// b - a [tau], with an error below 6e-17 tau, or an ulp of the difference if that is larger.
inline double operator-(const ModelTime& b, const ModelTime& a) {
  return static_cast<double>(b.tau - a.tau) + (b.phase - a.phase);
}

inline bool operator<(const ModelTime& a, const ModelTime& b) {
  return a.tau != b.tau ? a.tau < b.tau : a.phase < b.phase;
}
inline bool operator==(const ModelTime& a, const ModelTime& b) { return a.tau == b.tau && a.phase == b.phase; }
inline bool operator<=(const ModelTime& a, const ModelTime& b) { return !(b < a); }

// The time of the n-th sample: n * period, rounded once. A plain product would lose the digits of its whole part.
ModelTime multiply(std::uint64_t n, double period);

// The state inside the core. It has the gap instead of the height, because near the surface the gap is a small
// difference of large numbers: computed from (y, u, w) its digits would be lost.
struct TipState {
  double phase = 0.0;  // surface phase x mod 1 [a], crest = 0
  double X = 0.0;      // extension x - xc [a]
  double u = 0.0;      // lab horizontal velocity [a/tau]
  double g = 0.0;      // gap y - h(x) [a]; exactly 0 at an impact
  double g1 = 0.0;     // gap rate w - h'(x) u [a/tau]; after an impact > 0
};

// The same in lab coordinates, for users.
struct FreeState {
  double phase = 0.0;  // [a], crest = 0
  double X = 0.0;      // extension x - xc [a]
  double y = 0.0;      // lab height [a]
  double u = 0.0;      // lab velocity [a/tau]
  double w = 0.0;
};

// A flight at one time, in the frame of the holder: surface phase, extensions X = x - xc and Y = y - y0 [a], and their
// rates [a/tau].
template <class T>
struct FlightState {
  T phase, X, U, Y, W;
};

// The gap y - h(x) of a flight and its time derivatives, with the state they belong to, and the height and slope of the
// surface below it.
template <class T>
struct GapJet {
  T g, g1, g2, g3;
  FlightState<T> state;
  T h, h1;
};

enum class ImpactKind : std::uint8_t { impact = 0, burst = 1, contact_begun = 2, contact_ended = 3 };

// Below the surface by no more than the rounding of H cos(2 pi phase) is on it.
TipState to_tip_state(double H, const FreeState& state);
FreeState to_free_state(double H, const TipState& state);

// At rest in a valley of the surface, the lateral spring relaxed: a tip that was lowered gently under a load. Dropped
// onto the surface instead, it would keep the energy of its fall for good if nothing damps it.
inline FreeState lowered_tip(double H) { return {0.5, 0.0, -H, 0.0, 0.0}; }

// One entry of the impact log. Velocities are those before the impact. A burst is the event of a whole chatter sequence
// and happens at its end: time, place and tangential velocity are those there. Where a kick or a change cuts it, place
// and tangential velocity are those of its last bounce. Its normal speed is the one with which the sequence begins,
// after the impact that was reported before. Loss and count are those of all its bounces. A collapse
// (docs/algorithm.md) includes the impact before them: its normal speed is that before this impact, or right after the
// kick that starts it.
struct Impact {
  ModelTime time;
  double surface_phase = 0.0;        // [a] in [0, 1)
  double normal_speed = 0.0;         // |n.v| [a/tau]. For the hammer model: the gap rate |w - h' u|
  double tangential_velocity = 0.0;  // t.v [a/tau]
  double energy_loss = 0.0;          // [m_tip a^2/tau^2]
  ImpactKind kind = ImpactKind::impact;
  std::uint32_t count = 1;  // bounces it stands for
};

// How an advance ended. Trouble is a value that is counted, not an exception.
enum class Outcome : std::uint8_t {
  impact,        // the tip has just bounced; the record is the tip's last impact
  time_limit,    // the time asked for was reached first
  flying,        // no event: a segment has ended, and the motion goes on
  budget_spent,  // the budget of impacts ran out before the time asked for
  contact,       // contact has begun: the tip slides
  released,      // contact has ended
  // A search failed. After Tip::advance_segment() the motion goes on from a time that is certified free of impacts, if
  // that is later than the segment's start; after Tip::advance() it cannot go on.
  search_failed
};

}  // namespace afm
