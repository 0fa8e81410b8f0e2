#include "grid.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <sstream>

#include "afm/number_text.h"

namespace afm {
namespace {

const char* name_of(SweepDirection direction) {
  return direction == SweepDirection::fresh ? "fresh" : direction == SweepDirection::up ? "up" : "down";
}

// The faults of a point with this axis's value and defaults otherwise.
void add_faults(std::vector<ParameterError>& all, const SweepPoint& point) {
  constexpr std::size_t kMost = 10;  // a long range outside the limits has as many faults as points
  for (const ParameterError& fault : find_faults(point)) {
    if (all.size() < kMost) all.push_back(fault);
  }
}

}  // namespace

bool parse(const std::string& name, SweepDirection& direction) {
  for (const SweepDirection each : {SweepDirection::fresh, SweepDirection::up, SweepDirection::down}) {
    if (name == name_of(each)) return direction = each, true;
  }
  return false;
}

std::vector<ParameterError> find_faults(const CurveSettings& s) {
  constexpr SweepPoint good{1.0, 0.5, 0.1};
  std::vector<ParameterError> faults;
  for (const double eta : s.eta) add_faults(faults, {eta, good.gamma, good.v_c});
  for (const double gamma : s.gamma) add_faults(faults, {good.eta, gamma, good.v_c});
  for (const double cutoff : s.cutoff) add_faults(faults, {good.eta, good.gamma, cutoff});
  // a holder above one of the crests hovers there
  for (const double y0 : s.rest_height) {
    for (const double H : s.amplitude) add_faults(faults, {good.eta, good.gamma, good.v_c, s.model, y0, H});
  }
  for (const double ratio : s.frequency_ratio) {
    SweepPoint point = good;
    point.frequency_ratio = ratio;
    add_faults(faults, point);
  }
  for (const ParameterError& fault : find_faults(s.sweep)) faults.push_back(fault);
  double points = 1.0;
  for (const auto* axis : {&s.eta, &s.gamma, &s.cutoff, &s.rest_height, &s.amplitude, &s.frequency_ratio}) {
    points *= static_cast<double>(axis->size());
  }
  for (const ParameterError& fault : find_point_count_fault(points)) faults.push_back(fault);
  const auto fall = std::adjacent_find(s.eta.begin(), s.eta.end(), std::greater_equal<>());
  if (s.direction != SweepDirection::fresh && fall != s.eta.end()) {
    faults.emplace_back("eta", *(fall + 1), "must ascend where sweep is up or down");
  }
  const Bath& bath = s.sweep.bath;
  if (s.model == ModelKind::hammer && bath.temperature > 0.0 && bath.is_on() && bath.quality_factor == 0.0) {
    faults.emplace_back("temperature", bath.temperature,
                        "needs a quality factor above 0: the hammer has no lateral spring, so no heat reaches the tip");
  }
  return faults;
}

std::vector<ParameterError> find_warnings(const CurveSettings& s) {
  std::vector<ParameterError> warnings;
  const auto is_slower = [](double a, double b) { return a != 0.0 && (b == 0.0 || std::abs(a) < std::abs(b)); };
  const double slowest = *std::min_element(s.eta.begin(), s.eta.end(), is_slower);
  const double lowest = *std::min_element(s.rest_height.begin(), s.rest_height.end());
  const double highest = *std::max_element(s.amplitude.begin(), s.amplitude.end());
  for (const double ratio : s.frequency_ratio) {
    const SweepPoint point{slowest, s.gamma.front(), s.cutoff.front(), s.model, lowest, highest, ratio};
    for (const ParameterError& warning : find_warnings(point, s.sweep)) warnings.push_back(warning);
    for (const double eta : s.eta) {
      SweepPoint other = point;
      other.eta = eta;
      for (const ParameterError& warning : find_warnings(other, s.sweep.bath)) {
        const auto is_same = [&](const ParameterError& known) { return known.reason == warning.reason; };
        if (std::none_of(warnings.begin(), warnings.end(), is_same)) warnings.push_back(warning);
      }
    }
  }
  return warnings;
}

std::string identity(const CurveSettings& s) {
  std::ostringstream text;
  const auto add = [&](const char* name, const std::vector<double>& axis) {
    text << name << "=" << number_text(axis.front()) << ".." << number_text(axis.back()) << "(" << axis.size() << ") ";
  };
  add("eta", s.eta);
  add("gamma", s.gamma);
  add("cutoff", s.cutoff);
  add("rest-height", s.rest_height);
  add("amplitude", s.amplitude);
  add("frequency-ratio", s.frequency_ratio);
  text << "temperature=" << number_text(s.sweep.bath.temperature)
       << " quality-factor=" << number_text(s.sweep.bath.quality_factor)
       << " lateral-quality-factor=" << number_text(s.sweep.bath.lateral_quality_factor)
       << " kicks-per-tau=" << number_text(s.sweep.bath.kicks_per_tau) << " ";
  text << "duration=" << number_text(s.sweep.duration) << " transient=" << number_text(s.sweep.transient)
       << " model=" << name(s.model) << " sweep=" << name_of(s.direction) << " seed=" << s.sweep.seed;
  text << " average=" << (s.method == sweep_point ? "time" : "attractor") << " version=" << AFM_EMULATOR_VERSION;
  return text.str();
}

std::size_t CurveSettings::size() const {
  return eta.size() * gamma.size() * cutoff.size() * rest_height.size() * amplitude.size() * frequency_ratio.size();
}

SweepPoint CurveSettings::at(std::size_t position) const {
  const std::size_t n = eta.size(), column = position % n;
  position /= n;
  const auto next = [&position](const std::vector<double>& axis) {
    const double value = axis[position % axis.size()];
    position /= axis.size();
    return value;
  };
  SweepPoint point{eta[direction == SweepDirection::down ? n - 1 - column : column], 0.0, 0.0, model};
  point.gamma = next(gamma);
  point.v_c = next(cutoff);
  point.y0 = next(rest_height);
  point.H = next(amplitude);
  point.frequency_ratio = next(frequency_ratio);
  return point;
}

std::vector<SweepResult> compute_chain(const CurveSettings& settings, std::size_t begin,
                                       std::atomic<std::size_t>& done) {
  std::vector<SweepResult> results;
  TipState start = random_start(settings.at(begin), settings.sweep.seed, begin);
  for (std::size_t row = begin; row < begin + settings.chain_length(); ++row, ++done) {
    SweepSettings own = settings.sweep;
    own.bath.stream = row;
    results.push_back(settings.method(settings.at(row), own, start));
    start = results.back().end;
  }
  return results;
}

}  // namespace afm
