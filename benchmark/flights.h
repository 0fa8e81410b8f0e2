// Flights to compare methods on: starts that lie on the attractor, each with its truth in quad precision.
#pragma once

#include <string>
#include <vector>

#include "truth.h"

namespace afm {

constexpr double kFlightHorizon = 8.0;  // [tau]

struct Flight113 {
  TipState start;
  TrueImpact truth;
  double after;  // duration of the next flight [tau]: how near the next impact is

  // An impact belongs to this flight where it is nearer to it than to its neighbours, and not far off.
  double earliest() const {
    return static_cast<double>(truth.dt) - std::fmin(kFar, 0.5 * static_cast<double>(truth.dt));
  }
  double latest() const { return static_cast<double>(truth.dt) + std::fmin(kFar, 0.5 * after); }

  static constexpr double kFar = 0.02;  // [tau]
};

struct FlightScene {
  std::string name;
  Model model;
  double eta;
  std::vector<Flight113> flights;
};

// `count` flights spread at random over 100 tau of the attractor, or fewer where it has fewer impacts.
FlightScene sample_attractor(const std::string& name, const Model& model, double eta, std::size_t count, unsigned seed);

// False where the start has no impact within the horizon, or leads to none.
bool add_flight(FlightScene& scene, const TipState& start);

struct FlightScore {
  std::vector<double> errors;  // of the impacts found
  std::size_t missed = 0, phantom = 0;

  void add(const Flight113& flight, const rivals::Hit& hit, const FlightScene& scene);
};

}  // namespace afm
