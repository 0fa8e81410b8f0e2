#include "grid.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <sstream>

namespace afm {
namespace {

const char* name_of(SweepDirection direction) {
  return direction == SweepDirection::fresh ? "fresh" : direction == SweepDirection::up ? "up" : "down";
}

// The fewest digits that give the same number back.
std::string shortest(double x) {
  char text[32];
  for (int digits = 6; digits <= 17; ++digits) {
    std::snprintf(text, sizeof text, "%.*g", digits, x);
    if (std::strtod(text, nullptr) == x) break;
  }
  return text;
}

// Of the faults of a point with this axis's value and defaults otherwise.
void add_faults(std::vector<ParameterError>& all, const SweepPoint& point) {
  for (const ParameterError& fault : find_faults(point)) {
    if (all.size() < 10) all.push_back(fault);
  }
}

}  // namespace

std::vector<ParameterError> find_faults(const CurveSettings& s) {
  constexpr SweepPoint good{1.0, 0.5, 0.1};
  std::vector<ParameterError> faults;
  for (const double eta : s.eta) add_faults(faults, {eta, good.gamma, good.v_c});
  for (const double gamma : s.gamma) add_faults(faults, {good.eta, gamma, good.v_c});
  for (const double cutoff : s.cutoff) add_faults(faults, {good.eta, good.gamma, cutoff});
  for (const ParameterError& fault : find_faults(s.sweep)) faults.push_back(fault);
  return faults;
}

std::string identity(const CurveSettings& s) {
  std::ostringstream text;
  const auto add = [&](const char* name, const std::vector<double>& axis) {
    text << name << "=" << shortest(axis.front()) << ".." << shortest(axis.back()) << "(" << axis.size() << ") ";
  };
  add("eta", s.eta);
  add("gamma", s.gamma);
  add("cutoff", s.cutoff);
  text << "duration=" << shortest(s.sweep.duration) << " transient=" << shortest(s.sweep.transient)
       << " model=" << name(s.model) << " sweep=" << name_of(s.direction) << " seed=" << s.sweep.seed;
  text << " version=" << AFM_EMULATOR_VERSION;
  return text.str();
}

SweepGrid::SweepGrid(const CurveSettings& s)
    : eta_(s.eta), gamma_(s.gamma), cutoff_(s.cutoff), kind_(s.model), chained_(s.direction != SweepDirection::fresh) {
  if (s.direction == SweepDirection::down) std::reverse(eta_.begin(), eta_.end());
}

SweepPoint SweepGrid::at(std::size_t position) const {
  const std::size_t row = position / eta_.size();
  return {eta_[position % eta_.size()], gamma_[row % gamma_.size()], cutoff_[row / gamma_.size()], kind_};
}

}  // namespace afm
