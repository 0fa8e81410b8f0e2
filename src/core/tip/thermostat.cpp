#include "afm/thermostat.h"

#include <cmath>

#include "core/portable_exp.h"
#include "core/tip/normal_pair.h"

namespace afm {

using namespace detail;

namespace {

VelocityKick kick_of(double temperature, double angle, double quality_factor) {
  if (quality_factor == 0.0) return {};
  constexpr double kMaxExponent = 600.0;  // within portable_exp; e^-600 is as good as 0
  const double keep = portable_exp(-std::fmin(angle / quality_factor, kMaxExponent));
  return {keep, std::sqrt((1.0 - keep) * (1.0 + keep) * temperature)};
}

}  // namespace

void Thermostat::set(const Bath& bath, double frequency_ratio, const ModelTime& now) {
  if (!bath_.is_on() || bath.kicks_per_tau != bath_.kicks_per_tau) grid_ = {1.0 / bath.kicks_per_tau, kicks_, now};
  bath_ = bath;
  prepare(frequency_ratio);
}

// Sets the members that follow from the others.
void Thermostat::prepare(double frequency_ratio) {
  const double angle = kTwoPi / bath_.kicks_per_tau;  // of the vertical spring from kick to kick
  scale_.vertical = kick_of(bath_.temperature, angle, bath_.quality_factor);
  scale_.lateral = kick_of(bath_.temperature, frequency_ratio * angle, bath_.lateral_quality());
  next_ = bath_.is_on() ? grid_.time_or_end(kicks_ + 1) : kEndOfTime;
}

Kick Thermostat::draw() {
  const NormalPair xi = normal_pair(bath_.seed, bath_.stream, ++kicks_);
  next_ = grid_.time(kicks_ + 1);
  Kick kick = scale_;
  kick.lateral.noise *= xi.first;
  kick.vertical.noise *= xi.second;
  return kick;
}

}  // namespace afm
