// What may change while the emulator runs: plain values, so that they travel through lock-free queues.
#pragma once

#include <afm_emulator/Applied.h>
#include <afm_emulator/EmulatorConfig.h>

namespace afm::node {

struct Parameters;

// In force together. Named as on the parameter server.
struct Live {
  double drag_velocity = 0.0;  // [m/s], signed
  double restitution_gamma = 0.0;
  double cutoff_speed = 0.0;  // [m/s]
  double rest_height_m = 0.0;
  double sample_rate_hz = 0.0;  // of model time
  double friction_window_tau = 0.0;
  double temperature_k = 0.0;
  double quality_factor = 0.0, lateral_quality_factor = 0.0;
  double kicks_per_tau = 0.0;
};

// Those that dynamic_reconfigure changes, and where they stand in the message that reports them.
struct LiveField {
  double Live::*value;
  double afm_emulator::Applied::*applied;
  double afm_emulator::EmulatorConfig::*config;
};
#define AFM_LIVE_FIELD(name) {&Live::name, &afm_emulator::Applied::name, &afm_emulator::EmulatorConfig::name}
inline constexpr LiveField kLiveFields[] = {
    AFM_LIVE_FIELD(restitution_gamma),   AFM_LIVE_FIELD(cutoff_speed),  AFM_LIVE_FIELD(rest_height_m),
    AFM_LIVE_FIELD(sample_rate_hz),      AFM_LIVE_FIELD(friction_window_tau),
    AFM_LIVE_FIELD(temperature_k),       AFM_LIVE_FIELD(quality_factor),
    AFM_LIVE_FIELD(lateral_quality_factor), AFM_LIVE_FIELD(kicks_per_tau)};
#undef AFM_LIVE_FIELD

Live live_of(const Parameters& parameters);
void set_live(const Live& live, Parameters& parameters);  // allocates nothing

}  // namespace afm::node
