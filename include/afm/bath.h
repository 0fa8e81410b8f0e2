// The heat bath of the cantilever, at rest in the frame of the holder: Langevin dynamics of both springs. We split it
// into exact motion for 1/kicks_per_tau and kicks. A kick is the exact Ornstein-Uhlenbeck step of both velocities.
// Guarantee: without drag and with gamma = 1 the Boltzmann distribution above the surface is stationary for every rate
// of kicks (docs/temperature.md).
#pragma once

#include <cstdint>
#include <vector>

#include "model.h"

namespace afm {

// Energy of a free spring decays like exp(-omega t / Q) at Q well above 1/2, the better the more kicks there are in the
// time Q / omega.
struct Bath {
  double temperature = 0.0;             // kT [m_tip a^2/tau^2]; 0: damping alone
  double quality_factor = 0.0;          // of the vertical spring; 0: neither damped nor heated
  double lateral_quality_factor = 0.0;  // of the horizontal spring; 0: as the vertical one
  double kicks_per_tau = 29.034;        // see suitable_kicks()
  std::uint64_t seed = 1;               // of the random numbers
  std::uint64_t stream = 0;             // which of the seed's sequences: many tips have one each

  bool is_on() const { return quality_factor > 0.0 || lateral_quality_factor > 0.0; }
  double lateral_quality() const { return lateral_quality_factor > 0.0 ? lateral_quality_factor : quality_factor; }
};

bool operator==(const Bath& a, const Bath& b);
inline bool operator!=(const Bath& a, const Bath& b) { return !(a == b); }

constexpr double kMaxTemperature = 1000.0;  // [m_tip a^2/tau^2]: mica's tip at 324,000 K
constexpr double kMinQualityFactor = 0.1;   // overdamped; or 0
constexpr double kMinKickRate = 0.01;       // [1/tau]
constexpr double kMaxKickRate = 1000.0;     // [1/tau]

// Every fault, named as in Bath.
std::vector<ParameterError> find_faults(const Bath& bath);

// Whether the kicks lock, because from kick to kick the lateral spring makes nearly a whole or half number of turns, or
// the holder passes nearly a whole or half number of cells. K_f may then be wrong by a fifth (docs/levers.md), or
// depend on the start (docs/temperature.md). eta: drag velocity [a/tau]; 0: whatever it is. False without a bath. The
// hammer has no lateral spring. Precondition of this and of the next two: a model and a bath without faults.
bool kicks_lock(const Model& model, const Bath& bath, double eta = 0.0);

// A rate of kicks [1/tau] for this model and these quality factors; the rate that the bath has does not count.
// Guarantee: it does not lock, and takes at most 0.11 of a velocity at once, or 0.123 where 0.11 needs more than 1000 a
// tau or omega_h/omega_v is above 389, or find_warnings() reports it.
double suitable_kicks(const Model& model, const Bath& bath, double eta = 0.0);

// What can be run, but is seldom meant, with the remedy: kicks that lock or are too few, and a bath that acts on no
// spring of the hammer. Named as in Bath.
std::vector<ParameterError> find_warnings(const Model& model, const Bath& bath, double eta = 0.0);

}  // namespace afm
