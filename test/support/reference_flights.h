// Flights from one impact to the next, computed in 128-bit floats with a guaranteed search: test/data/next_impact*.csv.
#pragma once

#include <array>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "afm/model.h"
#include "afm/state.h"
#include "afm/surface.h"
#include "core/search/double_double.h"
#include "trials/quad.h"

namespace afm {

// Natural units. The start and `after` hold lab velocities after their impact, `normal_speed` and
// `tangential_velocity` are incident.
struct ReferenceFlight {
  double eta, gamma, v_c, phase, X, u, w;  // exact
  Quad dt, phase_next, X_next, u_next, w_next, normal_speed, tangential_velocity, energy_loss;

  Model model() const {
    Model m;
    m.gamma = gamma;
    m.v_c = v_c;
    return m;
  }

  // The gap rate is a small difference of velocities: taken in double-double.
  TipState start() const {
    const detail::DoubleDouble slope = surface_jet(detail::DoubleDouble(model().H), detail::DoubleDouble(phase)).h1;
    return {phase, X, u, 0.0, static_cast<double>(detail::DoubleDouble(w) - slope * detail::DoubleDouble(u))};
  }
};

inline ReferenceFlight parse_reference_flight(const std::string& line) {
  constexpr std::size_t kInputs = 7, kOutputs = 8;
  std::array<double, kInputs> in{};
  std::array<Quad, kOutputs> out{};
  std::istringstream fields(line);
  std::string field;
  std::size_t n = 0;
  for (; std::getline(fields, field, ','); ++n) {
    if (n < kInputs)
      in[n] = std::stod(field);
    else if (n < kInputs + kOutputs)
      out[n - kInputs] = Quad(field);
  }
  if (n != kInputs + kOutputs) throw std::runtime_error("reference flight with " + std::to_string(n) + " fields");
  return {in[0],  in[1],  in[2],  in[3],  in[4],  in[5],  in[6], out[0],
          out[1], out[2], out[3], out[4], out[5], out[6], out[7]};
}

inline std::vector<ReferenceFlight> read_reference_flights(const std::string& path) {
  std::ifstream file(path);
  std::string line;
  if (!std::getline(file, line)) throw std::runtime_error("cannot read " + path);
  std::vector<ReferenceFlight> flights;
  while (std::getline(file, line)) flights.push_back(parse_reference_flight(line));
  return flights;
}

}  // namespace afm
