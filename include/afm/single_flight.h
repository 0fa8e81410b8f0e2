// From one impact to the next, in lab coordinates and natural units.
#pragma once

#include <vector>

#include "model.h"

namespace afm {

// A post-impact state on the surface, and the model it flies in; named as the columns of the tool next_impact.
struct FlightInput {
  double eta, gamma, cutoff;                               // [a/tau], [-], [a/tau]
  double phase, extension;                                 // [a]
  double u, w;                                             // [a/tau]
  ModelKind kind = ModelKind::oscillator;                  // hammer: extension and u are 0 and eta, whatever is given
  double rest_height = Model{}.y0, amplitude = Model{}.H;  // [a]
  double frequency_ratio = Model{}.frequency_ratio;
};

// The next impact; velocities u and w after it, normal speed and tangential velocity before it.
struct FlightResult {
  double dt;                                       // [tau]
  double phase, extension;                         // [a]
  double u, w, normal_speed, tangential_velocity;  // [a/tau]
  double energy_loss;                              // [m_tip a^2/tau^2]
};

constexpr double kLongestFlight = 1000.0;  // [tau]

// Every fault, by the names above.
std::vector<ParameterError> find_faults(const FlightInput& input);

// Throws std::invalid_argument with every fault of the input, std::runtime_error where there is no impact to be found.
FlightResult fly_to_next_impact(const FlightInput& input);

}  // namespace afm
