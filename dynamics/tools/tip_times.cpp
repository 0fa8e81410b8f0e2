#include "tip_times.h"

#include <algorithm>
#include <cstddef>
#include <limits>

#include "common/cpu_clock.h"

namespace afm {
namespace {

constexpr std::size_t kRounds = 15;
constexpr double kInterval = 40.0, kTransient = 120.0;  // [tau]

void fly(Tip& tip, double duration) {
  constexpr int kMostEvents = 20000;  // chatter bounce by bounce would not end
  const ModelTime end = tip.now() + duration;
  for (int i = 0; i < kMostEvents && tip.advance(end) != Outcome::time_limit; ++i) {
  }
}

double time_of_stretch(Tip& tip) {
  const ModelTime begin = tip.now();
  const double from = thread_seconds();
  fly(tip, kInterval);
  const double spent = thread_seconds() - from, passed = tip.now() - begin;
  return passed > 0.0 ? 1e9 * spent / passed : std::numeric_limits<double>::infinity();
}

double median(std::vector<double>& values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace

std::vector<double> nanoseconds_per_tau(std::vector<Tip> tips) {
  for (std::size_t i = 0; i < tips.size(); ++i) fly(tips[i], kTransient + static_cast<double>(i * kRounds) * kInterval);
  std::vector<std::vector<double>> times(tips.size());
  for (std::size_t round = 0; round < kRounds; ++round) {
    for (std::size_t i = 0; i < tips.size(); ++i) times[i].push_back(time_of_stretch(tips[i]));
  }
  std::vector<double> medians;
  for (std::vector<double>& of_tip : times) medians.push_back(median(of_tip));
  return medians;
}

}  // namespace afm
