#include "live.h"

#include "parameters.h"

namespace afm::node {

Live live_of(const Parameters& p) {
  return {p.drag_velocity,      p.si.restitution_gamma, p.si.cutoff_speed,    p.si.rest_height_m,
          p.sample_rate_hz,     p.friction_window_tau,  p.bath.temperature_k, p.bath.quality_factor,
          p.bath.lateral_quality_factor, p.bath.kicks_per_tau};
}

void set_live(const Live& live, Parameters& p) {
  p.drag_velocity = live.drag_velocity;
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

}  // namespace afm::node
