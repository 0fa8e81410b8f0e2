#include "view/heard.h"

#include <algorithm>

#include "node/message_conversion.h"

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
  const double kept = kPathTau / message.sample_period_tau +
                      kKeptWallTime * message.sample_rate_hz * message.time_scale +
                      4.0 * static_cast<double>(message.samples_per_batch);
  trace_.keep(static_cast<std::size_t>(std::min(kept, kMostSamples)));
}

void Heard::take(const afm_emulator::Deflection& message) {
  if (units_) trace_.add(message, *units_, configuration_->sample_period_tau);
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
