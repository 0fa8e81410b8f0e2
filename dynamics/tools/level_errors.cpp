#include "level_errors.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <limits>

#include "afm/sweep.h"
#include "common/cpu_clock.h"

namespace afm {
namespace {

// Finest first; the full model is the oscillator at the default tolerance.
const Level kLadder[] = {{ModelKind::oscillator, 0.0},  {ModelKind::oscillator, 1e-5},
                         {ModelKind::oscillator, 1e-4}, {ModelKind::oscillator, kDefaultContactTolerance},
                         {ModelKind::oscillator, 1e-2}, {ModelKind::hammer, kDefaultContactTolerance}};
constexpr std::size_t kLevels = std::size(kLadder), kFull = 3;
constexpr double kTooDear = 1.2;  // times the full model
constexpr double kWorst = 1e3;    // larger relative errors contain no more information
constexpr double kStandardErrors = 2.0;

TipState start_of(const Model& model, double eta, const LevelErrorSettings& settings, int index) {
  return random_start({eta, model.gamma, model.v_c}, settings.seed, static_cast<std::uint64_t>(index));
}

constexpr std::size_t kRounds = 15;                       // of the timing
constexpr double kTimedInterval = 40.0, kWarmUp = 120.0;  // [tau]

void fly(Tip& tip, double duration) {
  constexpr int kMostEvents = 20000;  // chatter bounce by bounce would not end
  const ModelTime end = tip.now() + duration;
  for (int i = 0; i < kMostEvents && tip.advance(end) != Outcome::time_limit; ++i) {
  }
}

double time_of_interval(Tip& tip) {
  const ModelTime begin = tip.now();
  const double from = thread_seconds();
  fly(tip, kTimedInterval);
  const double spent = thread_seconds() - from, passed = tip.now() - begin;
  return passed > 0.0 ? 1e9 * spent / passed : std::numeric_limits<double>::infinity();
}

double median(std::vector<double>& values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

// Over that of the full model.
std::vector<double> measure_costs(const Model& model, double eta, const TipState& start) {
  std::vector<Tip> tips;
  for (const Level& level : kLadder) tips.emplace_back(at_level(model, level), eta, start, level.contact_tolerance);
  std::vector<double> costs = nanoseconds_per_tau(tips);
  const double full = costs[kFull];
  for (double& cost : costs) cost /= full;
  return costs;
}

// Never more events in an interval than a quarter of what the shipped impact budget allows a batch: the mean says too
// little, as one contact in ten thousand may hold millions of bounces.
bool keeps_time(const Model& model, double eta, const Level& level, const TipState& start) {
  constexpr double kInterval = 50.0;  // [tau]
  constexpr int kIntervals = 400, kMostEvents = 10000;
  Tip tip(at_level(model, level), eta, start, level.contact_tolerance);
  for (int i = 0; i < kIntervals; ++i) {
    const ModelTime end = tip.now() + kInterval;
    int events = 0;
    while (tip.advance(end) != Outcome::time_limit) {
      if (++events > kMostEvents) return false;
    }
  }
  return true;
}

using Runs = std::vector<LevelRun>;  // one for each start; none where the level cannot be afforded

Runs run_all(const Model& model, double eta, const Level& level, const LevelErrorSettings& settings) {
  Runs runs;
  for (int i = 0; i < settings.starts; ++i) {
    Tip tip(at_level(model, level), eta, start_of(model, eta, settings, i), level.contact_tolerance);
    runs.push_back(run_level(at_level(model, level), tip, settings.run));
    if (runs.back().share_measured == 0.0) return {};
  }
  return runs;
}

double friction_error(const LevelRun& run, const LevelRun& reference) {
  const FrictionAverage &a = run.friction, &b = reference.friction;
  if (a.K_f == b.K_f) return 0.0;
  const double noise = kStandardErrors * std::hypot(a.K_f_std_error, b.K_f_std_error);
  return (std::abs(a.K_f - b.K_f) + noise) / std::abs(b.K_f);
}

double deflection_error(const LevelRun& run, const LevelRun& reference) {
  return quantile_distance(run.vertical, reference.vertical) / reference.vertical_rms;
}

template <class Distance>
double distance(const Runs& runs, const Runs& references, Distance between) {
  double farthest = 0.0;
  for (const LevelRun& run : runs) {
    double nearest = kWorst;
    for (const LevelRun& reference : references) nearest = std::fmin(nearest, between(run, reference));
    farthest = std::fmax(farthest, nearest);
  }
  return farthest;
}

}  // namespace

std::vector<double> nanoseconds_per_tau(std::vector<Tip> tips) {
  for (std::size_t i = 0; i < tips.size(); ++i)
    fly(tips[i], kWarmUp + static_cast<double>(i * kRounds) * kTimedInterval);
  std::vector<std::vector<double>> times(tips.size());
  for (std::size_t round = 0; round < kRounds; ++round) {
    for (std::size_t i = 0; i < tips.size(); ++i) times[i].push_back(time_of_interval(tips[i]));
  }
  std::vector<double> medians;
  for (std::vector<double>& of_tip : times) medians.push_back(median(of_tip));
  return medians;
}

std::vector<MeasuredLevel> measure_levels(const Model& model, double eta, const LevelErrorSettings& settings) {
  const std::vector<double> costs = measure_costs(model, eta, start_of(model, eta, settings, 0));
  std::vector<MeasuredLevel> measured;
  Runs references;
  bool exact = false;
  for (std::size_t i = 0; i < kLevels; ++i) {
    if (i > kFull && costs[i] > kTooDear) continue;
    if (!keeps_time(model, eta, kLadder[i], start_of(model, eta, settings, 0))) continue;
    const Runs runs = run_all(model, eta, kLadder[i], settings);
    if (runs.empty()) continue;
    if (references.empty()) {
      references = runs;
      exact = i == 0;
    }
    measured.push_back(
        {kLadder[i],
         {distance(runs, references, friction_error), distance(runs, references, deflection_error), costs[i]}});
  }
  if (!exact && measured.size() > 1) {
    measured[0].error.friction = measured[1].error.friction;
    measured[0].error.deflection = measured[1].error.deflection;
  }
  return measured;
}

}  // namespace afm
