#include "heard.h"

#include <algorithm>

#include "node/wire/message_conversion.h"

namespace afm::view {
namespace {

constexpr double kKeptWallTime = 0.5;     // [s] of samples: impacts and samples travel on topics of their own
constexpr double kMostSamples = 2000000;  // 0.5 s at the fastest, and a tenfold replay of most

}  // namespace

void Heard::take(const afm_emulator::Configuration& message) {
  const SiModel si = node::si_model(message);
  configuration_ = message;
  units_ = Units(si);
  model_ = units_->to_natural(si);
  holder_.begin(message);
  keep(message.sample_rate_hz, message.sample_period_tau, message.samples_per_batch);
}

void Heard::take(const afm_emulator::AppliedParameters& message) {
  holder_.obey(message);
  if (!configuration_) return;
  configuration_->temperature_k = message.temperature_k;
  configuration_->quality_factor = message.quality_factor;
  configuration_->lateral_quality_factor = message.lateral_quality_factor;
  keep(message.sample_rate_hz, message.sample_period_tau, message.samples_per_batch);
}

void Heard::keep(double sample_rate_hz, double sample_period_tau, std::uint64_t samples_per_batch) {
  const double kept = kPathTau / sample_period_tau + kKeptWallTime * sample_rate_hz * configuration_->time_scale +
                      4.0 * static_cast<double>(samples_per_batch);
  trace_.keep(static_cast<std::size_t>(std::min(kept, kMostSamples)));
}

void Heard::take(const afm_emulator::Deflection& message) {
  if (!units_) return;
  // the digits that the core uses, as long as the sample rate is that of the start
  const bool as_at_start = message.sample_period == configuration_->sample_period;
  trace_.add(message, *units_,
             as_at_start ? configuration_->sample_period_tau : message.sample_period / units_->time());
}

void Heard::take(const afm_emulator::ImpactArray& message) {
  if (units_) trace_.add(message, *units_);
}

bool Heard::complete() {
  if (!configuration_ || !trace_.tells_of(configuration_->epoch) || holder_.epoch() != configuration_->epoch)
    return false;
  locate(trace_, model_, holder_);
  return true;
}

}  // namespace afm::view
