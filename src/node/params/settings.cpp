// From the parameters: the settings of a run, its batches, and the level of the model.
#include <algorithm>
#include <cmath>
#include <limits>

#include "parameters.h"

namespace afm::node {
namespace {

Level full_level(const Parameters& p) {
  Level level{ModelKind::oscillator, p.contact_tolerance};
  parse(p.model, level.kind);  // auto, or a fault that is reported elsewhere
  return level;
}

}  // namespace

std::uint64_t samples_per_batch(const Parameters& p) {
  constexpr double kMost = 1e15;  // of a damaged recording: its faults say what is wrong
  const double samples = std::round(p.sample_rate_hz * p.time_scale / p.batch_rate_hz);
  return static_cast<std::uint64_t>(std::min(std::max(1.0, samples), kMost));
}

std::chrono::nanoseconds batch_period(const Parameters& p) {
  const double seconds = static_cast<double>(samples_per_batch(p)) / (p.sample_rate_hz * p.time_scale);
  return std::chrono::nanoseconds(std::llround(seconds * 1e9));
}

double to_eta(double drag_velocity, const SiModel& si) { return drag_velocity / Units(si).velocity(); }

double most_drag_velocity(const SiModel& si) {
  double most = kMaxEta * Units(si).velocity();
  while (to_eta(most, si) > kMaxEta) most = std::nextafter(most, 0.0);
  return most;
}

RunSettings run_settings(const Parameters& p) {
  const Units units(p.si);
  RunSettings settings;
  settings.model = units.to_natural(p.si);
  settings.model.kind = full_level(p).kind;
  settings.bath = units.to_natural(p.bath);
  settings.eta = to_eta(p.drag_velocity, p.si);
  settings.initial = p.initial;
  settings.sample_period = 1.0 / (p.sample_rate_hz * units.time());
  settings.samples_per_batch = samples_per_batch(p);
  settings.friction_window = p.friction_window_tau;
  settings.impact_budget = p.impact_budget;
  settings.contact_tolerance = p.contact_tolerance;
  return settings;
}

Batch preallocated_batch(const Parameters& p) {
  Parameters fastest = p;
  fastest.sample_rate_hz = std::min(
      {kMaxSampleRate, kMaxWallSampleRate / p.time_scale, kMaxSamplesPerBatch * p.batch_rate_hz / p.time_scale});
  Batch batch;
  batch.vertical.reserve(samples_per_batch(fastest));
  batch.lateral.reserve(samples_per_batch(fastest));
  batch.impacts.reserve(p.impact_budget);
  return batch;
}

LevelChoice choose_level(const Parameters& p, const RunSettings& settings) {
  const Level full = full_level(p);
  if (!p.levels || settings.bath.is_on()) return {full, std::numeric_limits<double>::quiet_NaN()};
  ToleranceOf of = ToleranceOf::friction;
  parse(p.tolerance_of, of);
  return p.levels->choose(settings.model, settings.eta, p.tolerance, of, full);
}

}  // namespace afm::node
