#include "run_view.h"

#include <algorithm>

#include "node/publisher/messages.h"

namespace afm::view {
namespace {

constexpr double kKeptWallTime = 0.5;     // [s] of samples: impacts and samples travel on topics of their own
constexpr double kMostSamples = 2000000;  // 0.5 s at the fastest, and a tenfold replay of most

}  // namespace

void RunView::take(const afm_emulator::Configuration& message) {
  const SiModel si = node::to_parameters(message).si;
  configuration_ = message;
  units_ = Units(si);
  model_ = units_->to_natural(si);
  holder_.set_units(*units_);
  keep_enough();
}

void RunView::take(const afm_emulator::Applied& message) {
  applied_ = message;
  holder_.take(message);
  keep_enough();
}

void RunView::keep_enough() {
  if (!configuration_ || !applied_) return;
  const double kept = kPathTau / applied_->sample_period_tau +
                      kKeptWallTime * applied_->sample_rate_hz * configuration_->time_scale +
                      4.0 * static_cast<double>(applied_->samples_per_batch);
  trace_.keep(static_cast<std::size_t>(std::min(kept, kMostSamples)));
}

void RunView::take(const afm_emulator::Deflection& message) {
  if (!units_) return;
  // the digits that the core uses, if what is in force is known already
  const bool as_applied = applied_ && message.sample_period == 1.0 / applied_->sample_rate_hz;
  trace_.add(message, *units_, as_applied ? applied_->sample_period_tau : message.sample_period / units_->time());
  holder_.take(message);
}

void RunView::take(const afm_emulator::ImpactArray& message) {
  if (units_) trace_.add(message, *units_);
}

bool RunView::complete() const {
  return configuration_ && trace_.has_epoch(configuration_->epoch) && holder_.knows(configuration_->epoch);
}

}  // namespace afm::view
