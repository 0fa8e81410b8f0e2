// The map from just after one impact to just after the next, every bounce by itself: bursts and contact are off. A
// point of its section is a TipState with gap 0; its coordinates, here and in the Jacobian, are (phase, X, u, g1). The
// hammer's X and u are 0 and eta, whatever a start has there.
#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "afm/flight.h"
#include "jacobian.h"
#include "afm/model.h"
#include "afm/state.h"

namespace afm {

enum class MapOutcome : std::uint8_t {
  impact,
  no_flight,  // the tip does not leave the surface, or slower than a bounce can be (1e-16 a/tau): contact
  no_impact   // none within kLongestMapFlight, or the search gave up
};

constexpr double kLongestMapFlight = 64.0;  // [tau]

struct MapStep {
  MapOutcome outcome = MapOutcome::no_flight;
  TipState after;                                                   // the impact that ends the flight
  double dt = 0.0;                                                  // [tau]
  double normal_speed = 0.0;                                        // [a/tau], incident
  double tangential_velocity = 0.0;                                 // [a/tau]
  double energy_loss = 0.0;                                         // [m a^2/tau^2]
  SectionJacobian<double> J = SectionJacobian<double>::Identity();  // of `after` by the start
};

class PoincareMap {
 public:
  // Precondition: the model has no faults.
  PoincareMap(const Model& model, double eta) : model_(model), mechanics_(model), eta_(eta) {}

  // Impact time and state as exact as the search gives them: the first impact, never a later one.
  MapStep operator()(const TipState& start) const;

  // The smallest gap that a flight of duration dt has at a minimum on its way; infinity where there is none. Where it
  // falls to 0 the flight grazes, and an orbit that holds it ends.
  double clearance(const TipState& start, double dt) const;

  const Model& model() const { return model_; }
  double eta() const { return eta_; }

 private:
  TipState held(const TipState& start) const;

  Model model_;
  Mechanics<double> mechanics_;
  double eta_;
};

// b - a in the section's coordinates, phases the shorter way round.
Eigen::Vector4d section_difference(const TipState& b, const TipState& a);
TipState section_sum(const TipState& a, const Eigen::Vector4d& step);

}  // namespace afm
