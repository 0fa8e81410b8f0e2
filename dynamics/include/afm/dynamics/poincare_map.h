// The map from just after one impact to just after the next (section IV of the paper), without chatter and contact. A
// point of its section is a TipState with gap 0. Its coordinates, here and in the Jacobian, are (phase, X, u, g1). For
// the hammer X and u of a start are replaced by 0 and eta.
#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "afm/flight.h"
#include "afm/model.h"
#include "afm/state.h"
#include "jacobian.h"

namespace afm {

enum class MapOutcome : std::uint8_t {
  impact,
  no_flight,  // the gap rate is below kMinGapRate, and the surface does not fall away: contact
  no_impact   // none within kLongestMapFlight, or the search failed
};

constexpr double kLongestMapFlight = 64.0;  // [tau] a choice: 64 turns of the vertical spring without an impact

struct MapStep {
  MapOutcome outcome = MapOutcome::no_flight;
  TipState after;                                                   // the impact that ends the flight
  double dt = 0.0;                                                  // [tau]
  double normal_speed = 0.0;                                        // [a/tau], incident
  double tangential_velocity = 0.0;                                 // [a/tau]
  double energy_loss = 0.0;                                         // [m_tip a^2/tau^2]
  SectionJacobian<double> J = SectionJacobian<double>::Identity();  // of `after` by the start
};

class PoincareMap {
 public:
  // Precondition: the model has no faults.
  PoincareMap(const Model& model, double eta) : model_(model), springs_(model), eta_(eta) {}

  // Guarantee: the first impact, never a later one (impact_search.h).
  MapStep operator()(const TipState& start) const;

  // The smallest gap of a flight of duration dt at a minimum on its way [a]; infinity without a minimum. At 0 the
  // flight grazes.
  double clearance(const TipState& start, double dt) const;

  const Model& model() const { return model_; }
  double eta() const { return eta_; }

 private:
  TipState constrained(const TipState& start) const;

  Model model_;
  SpringConstants<double> springs_;
  double eta_;
};

// b - a in the coordinates of the section; phases differ by at most 1/2.
Eigen::Vector4d section_difference(const TipState& b, const TipState& a);
TipState section_sum(const TipState& a, const Eigen::Vector4d& step);

}  // namespace afm
