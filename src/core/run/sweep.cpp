#include "afm/sweep.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "afm/number_text.h"
#include "afm/surface.h"
#include "afm/tip.h"
#include "core/fault_list.h"
#include "core/run/interruptible_advance.h"

namespace afm {
namespace {

// 64 random bits from a counter (SplitMix64): the same on every machine.
std::uint64_t mix(std::uint64_t x) {
  x += 0x9e3779b97f4a7c15u;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
  return x ^ (x >> 31);
}

class Uniform {
 public:
  Uniform(std::uint64_t seed, std::uint64_t index) : state_(mix(mix(seed) ^ index)) {}
  double operator()(double from, double to) {
    state_ = mix(state_);
    return from + (to - from) * (static_cast<double>(state_ >> 11) * 0x1p-53);
  }

 private:
  std::uint64_t state_;
};

std::string option_of(std::string name) {
  std::replace(name.begin(), name.end(), '_', '-');
  return name;
}

}  // namespace

std::vector<ParameterError> find_faults(const SweepPoint& point) {
  std::vector<ParameterError> faults;
  for (const ParameterError& fault : find_faults(model_of(point))) {
    faults.emplace_back(option_of(detail::word_for(fault.name)), fault.value, fault.reason);
  }
  if (!(std::abs(point.eta) <= kMaxEta)) {
    faults.emplace_back("eta", point.eta, "the drag velocity must be finite and at most 1000 lattice spacings per tau");
  }
  return faults;
}

std::vector<ParameterError> find_faults(const SweepSettings& settings) {
  constexpr double kLongest = 1e12;  // [tau] a choice; model times stay exact far beyond
  std::vector<ParameterError> faults;
  if (!(settings.duration > 0.0 && settings.duration <= kLongest)) {
    faults.emplace_back("duration", settings.duration, "must be above 0 and at most 1e12 tau");
  }
  if (!(settings.transient >= 0.0 && settings.transient <= kLongest)) {
    faults.emplace_back("transient", settings.transient, "must be at least 0 and at most 1e12 tau");
  }
  for (const ParameterError& fault : find_faults(settings.bath)) {
    faults.emplace_back(option_of(fault.name), fault.value, fault.reason);
  }
  if (settings.bath.temperature > 0.0 && !settings.bath.is_on()) {
    faults.emplace_back("temperature", settings.bath.temperature,
                        "needs a quality factor above 0: without one no heat reaches the tip");
  }
  return faults;
}

std::vector<ParameterError> find_point_count_fault(double points) {
  constexpr double kMostPoints = 1e6;  // a choice: days, and a row of each waits in memory
  if (points <= kMostPoints) return {};
  return {ParameterError("points of the table", points, "must be at most 1e+06: give coarser or shorter ranges")};
}

std::vector<ParameterError> find_warnings(const SweepPoint& point, const Bath& bath) {
  std::vector<ParameterError> warnings;
  for (const ParameterError& warning : find_warnings(model_of(point), bath, point.eta))
    warnings.emplace_back(option_of(warning.name), warning.value, warning.reason);
  return warnings;
}

std::vector<ParameterError> find_short_drag(const char* name, double duration, double eta, double spacings) {
  if (eta == 0.0 || std::abs(eta) * duration >= spacings) return {};
  constexpr int kFew = 6;
  return {ParameterError(name, duration,
                         "at eta = " + number_text(eta) + " the holder passes only " +
                             rounded_text(std::abs(eta) * duration, kFew) +
                             " lattice spacings in it: the result is that of a place of the surface, whatever its " +
                             "error; give at least " + number_text(std::ceil(spacings / std::abs(eta))) + " tau")};
}

std::vector<ParameterError> find_warnings(const SweepPoint& point, const SweepSettings& settings) {
  constexpr double kSpacings = 10.0;
  std::vector<ParameterError> warnings = find_warnings(point, settings.bath);
  const double spacings = kSpacings * (1.0 + longest_extension(model_of(point)));
  for (const ParameterError& warning : find_short_drag("duration", settings.duration, point.eta, spacings)) {
    warnings.push_back(warning);
  }
  return warnings;
}

Model model_of(const SweepPoint& point) {
  Model model;
  model.gamma = point.gamma;
  model.v_c = point.v_c;
  model.kind = point.kind;
  model.y0 = point.y0;
  model.H = point.H;
  model.frequency_ratio = point.frequency_ratio;
  return model;
}

TipState random_start(const SweepPoint& point, std::uint64_t seed, std::uint64_t index) {
  Uniform random(seed, index);
  const double phase = random(0.0, 1.0), X = random(-0.1, 0.1), rise = random(0.0, 0.3);
  const double u = point.eta * random(0.5, 1.5), w = point.eta * random(-1.0, 1.0);
  const double H = model_of(point).H;
  return to_tip_state(H, {phase, X, surface_jet(H, phase).h + rise, u, w});
}

SweepResult sweep_point(const SweepPoint& point, const SweepSettings& settings, const TipState& start) {
  Tip tip(model_of(point), point.eta, start);
  SweepResult result;
  if (settings.bath.is_on()) {
    tip.set_bath(settings.bath);
    result.attractor = "thermal";
  }
  const ModelTime end = tip.now() + settings.transient;
  detail::bring_to(tip, end);  // a tip that cannot go on has no average either
  result.friction = average_over_time(tip, settings.duration);
  result.end = tip.tip_state();
  return result;
}

}  // namespace afm
