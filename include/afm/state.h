// Where the tip is and when: model time, states at the surface and in the air, the record of one impact.
#pragma once

#include <cmath>
#include <cstdint>

namespace afm {

// A time in whole tau and a phase in [0, 1): no digit is lost however long the run.
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

// b - a in tau; exact to an ulp of the difference.
inline double operator-(const ModelTime& b, const ModelTime& a) {
  return static_cast<double>(b.tau - a.tau) + (b.phase - a.phase);
}

inline bool operator<(const ModelTime& a, const ModelTime& b) {
  return a.tau != b.tau ? a.tau < b.tau : a.phase < b.phase;
}
inline bool operator==(const ModelTime& a, const ModelTime& b) { return a.tau == b.tau && a.phase == b.phase; }
inline bool operator<=(const ModelTime& a, const ModelTime& b) { return !(b < a); }

// n * period without the rounding of a plain product: the time of the n-th sample.
ModelTime multiply(std::uint64_t n, double period);

// What the core carries. The height is implied by the gap, and gap and gap rate are carried rather than recomputed from
// (y, u, w): near the surface they are small differences of large numbers and would be lost.
struct TipState {
  double phase = 0.0;  // surface phase x mod 1 [a], crest = 0
  double X = 0.0;      // extension x - xc [a]
  double u = 0.0;      // lab horizontal velocity [a/tau]
  double g = 0.0;      // gap y - h(x) [a]; exactly 0 at an impact
  double g1 = 0.0;     // gap rate w - h'(x) u [a/tau]; after an impact > 0
};

// The same in lab coordinates, for the border.
struct FreeState {
  double phase = 0.0;  // [a], crest = 0
  double X = 0.0;      // extension x - xc [a]
  double y = 0.0;      // lab height [a]
  double u = 0.0;      // lab velocity [a/tau]
  double w = 0.0;
};

enum class ImpactKind : std::uint8_t { impact = 0, burst = 1, contact_begun = 2, contact_ended = 3 };

TipState to_tip_state(double H, const FreeState& state);
FreeState to_free_state(double H, const TipState& state);

// One entry of the impact log. Velocities are those before the impact; for a burst, of its first bounce.
struct Impact {
  ModelTime time;
  double surface_phase = 0.0;        // [a] in [0, 1)
  double normal_speed = 0.0;         // |n.v| [a/tau]
  double tangential_velocity = 0.0;  // t.v [a/tau]
  double energy_loss = 0.0;          // [m a^2 / tau^2]
  ImpactKind kind = ImpactKind::impact;
  std::uint32_t count = 1;  // bounces it stands for
};

// How an advance ended. Trouble is data: it is counted and published, never thrown.
enum class Outcome : std::uint8_t {
  impact,        // the tip has just bounced; the record is the tip's last impact
  time_limit,    // the time asked for was reached first
  flying,        // nothing has happened; the flight is certified free of impacts up to here and goes on
  budget_spent,  // the budget of impacts ran out first: model time stands where it says
  contact,       // a burst has died out and the tip slides
  released,      // a slide has ended
  search_failed  // the search gave up at a point that is certified free of impacts; it goes on from there
};

}  // namespace afm
