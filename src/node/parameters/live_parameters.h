// The parameters that may change while the emulator runs: plain values, so that they travel through lock-free queues.
#pragma once

namespace afm::node {

struct Parameters;

// Named as on the parameter server.
struct LiveParameters {
  double restitution_gamma = 0.0;
  double cutoff_speed = 0.0;         // [m/s]
  double rest_height_m = 0.0;
  double sample_rate_hz = 0.0;       // of model time
  double friction_window_tau = 0.0;
  double temperature_k = 0.0;
  double quality_factor = 0.0, lateral_quality_factor = 0.0;
  double kicks_per_tau = 0.0;
};

// What a person who changes them must know of one of them.
struct LiveField {
  const char* name;
  double LiveParameters::*value;
  const char* description;
};
constexpr LiveField kLiveFields[] = {
    {"restitution_gamma", &LiveParameters::restitution_gamma, "restitution at and above the cutoff speed"},
    {"cutoff_speed", &LiveParameters::cutoff_speed,
     "[m/s] below it restitution rises towards 1; 0: the same at every speed"},
    {"rest_height_m", &LiveParameters::rest_height_m,
     "[m] of the holder above mid-surface; below the crest, or the tip hovers"},
    {"sample_rate_hz", &LiveParameters::sample_rate_hz, "[1/s of model time]"},
    {"friction_window_tau", &LiveParameters::friction_window_tau,
     "[tau] length of the sliding window of the friction estimate"},
    {"temperature_k", &LiveParameters::temperature_k, "[K] of the heat bath; without quality_factor of no effect"},
    {"quality_factor", &LiveParameters::quality_factor, "of the cantilever; 0: no heat bath, no damping"},
    {"lateral_quality_factor", &LiveParameters::lateral_quality_factor,
     "of the horizontal spring; 0: as quality_factor"},
    {"kicks_per_tau", &LiveParameters::kicks_per_tau, "[1/tau] how often the heat bath acts"}};

bool operator==(const LiveParameters& a, const LiveParameters& b);

LiveParameters live_parameters(const Parameters& parameters);
void set_live(const LiveParameters& live, Parameters& parameters);  // allocates nothing

// Between these a value may be accepted; what else it must hold, find_faults() knows. Infinite where there is no bound.
LiveParameters least_live(const Parameters& parameters);
LiveParameters most_live(const Parameters& parameters);

}  // namespace afm::node
