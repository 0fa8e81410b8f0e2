#include "afm/dynamics/model_error.h"

#include <algorithm>
#include <cmath>

#include "core/run/interruptible_advance.h"

namespace afm {
namespace {

constexpr double kSamplingInterval = 0.6180339887498949;  // [tau] the golden section: phases fill [0, 1) evenly

// The deflection at `t`, after all events until then. Precondition: t is not before now.
Deflection deflection_at(Tip& tip, const ModelTime& t) {
  detail::bring_to(tip, t);
  return tip.deflection(t);
}

double events_per_tau(const Attractor& a, double eta) {
  return a.cells_per_impact > 0.0 ? std::abs(eta) / a.cells_per_impact : 0.0;
}

// The duration that the budget of events allows, by the rate of events so far.
double affordable(const Attractor& a, double eta, const ErrorSettings& settings) {
  const double wanted = a.cells > 0 ? std::min(settings.duration, settings.periodic_duration) : settings.duration;
  return std::min(wanted, static_cast<double>(settings.most_events) / events_per_tau(a, eta));
}

void sample(Tip& tip, int samples, LevelRun& run) {
  const ModelTime begin = tip.now();
  double squares = 0.0, stretches = 0.0;
  for (int i = 0; i < samples; ++i) {
    const Deflection d = deflection_at(tip, begin + kSamplingInterval * i);
    run.vertical.push_back(d.vertical);
    squares += d.vertical * d.vertical;
    stretches += d.lateral * d.lateral;
    run.stretch_largest = std::max(run.stretch_largest, std::abs(d.lateral));
  }
  run.vertical_rms = std::sqrt(squares / samples);
  run.stretch_rms = std::sqrt(stretches / samples);
}

// Precondition: the samples are in order of time.
double noise_of(const std::vector<double>& samples) {
  const auto half = static_cast<std::ptrdiff_t>(samples.size() / 2);
  std::vector<double> first(samples.begin(), samples.begin() + half);
  std::vector<double> second(samples.begin() + half, samples.begin() + 2 * half);
  std::sort(first.begin(), first.end());
  std::sort(second.begin(), second.end());
  return quantile_distance(first, second);
}

}  // namespace

LevelRun run_level(const Model& model, Tip& tip, const ErrorSettings& settings) {
  LevelRun run;
  AttractorSettings search;
  search.transient = settings.transient;
  search.duration = std::min(settings.duration, 500.0);
  search.most_events = settings.most_events;
  const ModelTime begin = tip.now();
  run.attractor = find_attractor(model, tip, search);
  const bool got_there = tip.now() - begin >= settings.transient;
  if (!got_there || events_per_tau(run.attractor, tip.eta()) > settings.most_events_per_tau) {
    run.share_measured = 0.0;
    return run;
  }
  const double duration = affordable(run.attractor, tip.eta(), settings);
  run.friction = average_over_periods(tip, run.attractor.cells, duration);
  run.share_measured = duration / settings.duration;
  const int samples = run.attractor.cells > 0 ? std::min(settings.samples, settings.periodic_samples)
                                              : static_cast<int>(settings.samples * run.share_measured);
  sample(tip, std::max(2, samples), run);
  run.vertical_noise = noise_of(run.vertical);
  std::sort(run.vertical.begin(), run.vertical.end());
  return run;
}

double quantile_distance(const std::vector<double>& a, const std::vector<double>& b) {
  const std::size_t n = std::min(a.size(), b.size());
  double sum = 0.0;
  // the quantiles of the smaller set
  const auto quantile = [n](const std::vector<double>& v, std::size_t i) {
    return v[(2 * i + 1) * v.size() / (2 * n)];
  };
  for (std::size_t i = 0; i < n; ++i) sum += std::abs(quantile(a, i) - quantile(b, i));
  return n > 0 ? sum / static_cast<double>(n) : 0.0;
}

double tracking_error(const Model& model, const Level& level, Tip& reference, const ErrorSettings& settings) {
  constexpr int kPoints = 64;  // per tau, a choice: ten for each turn of mica's horizontal spring
  double squares = 0.0;
  for (int pair = 0; pair < settings.pairs; ++pair) {
    const ModelTime begin = reference.now() + kSamplingInterval * 3.0;
    deflection_at(reference, begin);
    reference.advance_segment(begin);
    Tip tip(at_level(model, level), reference.eta(), reference.tip_state(), level.contact_tolerance);
    const ModelTime tip_begin = tip.now();
    for (int i = 1; i <= kPoints; ++i) {
      const double age = static_cast<double>(i) / kPoints;
      const double difference =
          deflection_at(tip, tip_begin + age).vertical - deflection_at(reference, begin + age).vertical;
      squares += difference * difference;
    }
    reference.advance_segment(begin + 1.0);
  }
  return std::sqrt(squares / (static_cast<double>(settings.pairs) * kPoints));
}

}  // namespace afm
