#include "live_parameters.h"

#include <algorithm>
#include <limits>

#include "parameters.h"

namespace afm::node {

bool operator==(const LiveParameters& a, const LiveParameters& b) {
  return std::all_of(std::begin(kLiveFields), std::end(kLiveFields),
                     [&](const LiveField& field) { return a.*field.value == b.*field.value; });
}

LiveParameters live_parameters(const Parameters& p) {
  return {p.si.restitution_gamma, p.si.cutoff_speed,    p.si.rest_height_m,    p.sample_rate_hz,
          p.friction_window_tau,  p.bath.temperature_k, p.bath.quality_factor, p.bath.lateral_quality_factor,
          p.bath.kicks_per_tau};
}

void set_live(const LiveParameters& live, Parameters& p) {
  p.si.restitution_gamma = live.restitution_gamma;
  p.si.cutoff_speed = live.cutoff_speed;
  p.si.rest_height_m = live.rest_height_m;
  p.sample_rate_hz = live.sample_rate_hz;
  p.friction_window_tau = live.friction_window_tau;
  p.bath.temperature_k = live.temperature_k;
  p.bath.quality_factor = live.quality_factor;
  p.bath.lateral_quality_factor = live.lateral_quality_factor;
  p.bath.kicks_per_tau = live.kicks_per_tau;
}

LiveParameters least_live(const Parameters& p) {
  return {0.0, 0.0,         kMinRestHeight * p.si.lattice_spacing_m, least_sample_rate(p), kLeastFrictionWindow, 0.0, 0.0,
          0.0, kMinKickRate};
}

LiveParameters most_live(const Parameters& p) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  return {1.0,
          kInfinity,
          p.si.surface_amplitude_m,
          most_sample_rate(p),
          kMostFrictionWindow,
          kMaxTemperature * Units(p.si).temperature(),
          kInfinity,
          kInfinity,
          kMaxKickRate};
}

}  // namespace afm::node
