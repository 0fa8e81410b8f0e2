#include "afm/detail/thermostat.h"

#include <cmath>
#include <tuple>

#include "core/contact/portable_exp.h"
#include "core/tip/philox.h"

namespace afm {

bool operator==(const Bath& a, const Bath& b) {
  const auto fields = [](const Bath& x) {
    return std::tie(x.temperature, x.quality_factor, x.lateral_quality_factor, x.kicks_per_tau, x.seed, x.stream);
  };
  return fields(a) == fields(b);
}

std::vector<ParameterError> find_faults(const Bath& b) {
  std::vector<ParameterError> faults;
  const auto require = [&](bool holds, const char* name, double value, const char* reason) {
    if (!holds) faults.emplace_back(name, value, reason);
  };
  const auto is_quality = [](double q) { return q == 0.0 || (q >= kMinQualityFactor && std::isfinite(q)); };
  require(b.temperature >= 0.0 && b.temperature <= kMaxTemperature, "temperature", b.temperature,
          "kT must be between 0 and 1000 m a^2/tau^2");
  require(is_quality(b.quality_factor), "quality_factor", b.quality_factor, "must be 0 (no bath), or at least 0.1");
  require(is_quality(b.lateral_quality_factor), "lateral_quality_factor", b.lateral_quality_factor,
          "must be 0 (as the vertical one), or at least 0.1");
  require(b.kicks_per_tau >= kMinKickRate && b.kicks_per_tau <= kMaxKickRate, "kicks_per_tau", b.kicks_per_tau,
          "must be between 0.01 and 1000");
  return faults;
}

namespace {

// A 53-bit number in (0, 1].
double unit(std::uint64_t bits) { return static_cast<double>((bits >> 11) + 1) * 0x1p-53; }

// The method of Box and Muller.
NormalPair normals_of(double radius, double angle) {
  const double r = std::sqrt(-2.0 * portable_log(radius));
  const SinCos<double> turn = sin_cos_turns(angle);
  return {r * turn.cos, r * turn.sin};
}

VelocityKick kick_of(double temperature, double angle, double quality_factor) {
  if (quality_factor == 0.0) return {};
  constexpr double kMaxExponent = 600.0;  // within portable_exp; e^-600 is as good as 0
  const double keep = portable_exp(-std::fmin(angle / quality_factor, kMaxExponent));
  return {keep, std::sqrt((1.0 - keep) * (1.0 + keep) * temperature)};
}

std::uint64_t joined(std::uint32_t low, std::uint32_t high) { return low | static_cast<std::uint64_t>(high) << 32; }

}  // namespace

NormalPair normal_pair(std::uint64_t seed, std::uint64_t stream, std::uint64_t index) {
  const PhiloxCounter counter = {low_word(index), high_word(index), low_word(stream), high_word(stream)};
  const PhiloxCounter random = philox4x32(counter, {low_word(seed), high_word(seed)});
  return normals_of(unit(joined(random[0], random[1])), unit(joined(random[2], random[3])));
}

void Thermostat::set(const Bath& bath, double frequency_ratio, const ModelTime& now) {
  if (!bath_.is_on() || bath.kicks_per_tau != bath_.kicks_per_tau) grid_ = {1.0 / bath.kicks_per_tau, kicks_, now};
  bath_ = bath;
  prepare(frequency_ratio);
}

// Sets the members that follow from the others.
void Thermostat::prepare(double frequency_ratio) {
  const double Q_v = bath_.quality_factor,
               Q_h = bath_.lateral_quality_factor > 0.0 ? bath_.lateral_quality_factor : Q_v;
  const double angle = kTwoPi / bath_.kicks_per_tau;  // of the vertical spring from kick to kick
  scale_.vertical = kick_of(bath_.temperature, angle, Q_v);
  scale_.lateral = kick_of(bath_.temperature, frequency_ratio * angle, Q_h);
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
