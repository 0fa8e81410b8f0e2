#include "afm/dynamics/basins.h"

#include <algorithm>
#include <cmath>

#include "afm/time_average.h"

namespace afm {

TipState start_of(const SweepPoint& point, std::uint64_t index, const BasinSettings& settings) {
  return settings.given.empty() ? random_start(point, settings.seed, index)
                                : to_tip_state(point.H, settings.given[index]);
}

Visit visit(const SweepPoint& point, std::uint64_t index, const BasinSettings& settings) {
  Visit v;
  v.start = start_of(point, index, settings);
  const Model model = model_of(point);
  Tip tip(model, point.eta, v.start);
  v.attractor = find_attractor(model, tip, settings.attractor);
  const FrictionAverage friction = average_over_periods(tip, v.attractor.cells, settings.friction_duration);
  v.K_f = friction.K_f;
  v.K_f_std_error = friction.K_f_std_error;
  return v;
}

bool same_attractor(const Visit& a, const Visit& b) {
  if (a.attractor.kind != b.attractor.kind || a.attractor.impacts != b.attractor.impacts) return false;
  if (a.attractor.cells != b.attractor.cells) return false;
  if (std::isnan(a.K_f) && std::isnan(b.K_f)) return true;
  const double error = std::hypot(a.K_f_std_error, b.K_f_std_error);
  return std::abs(a.K_f - b.K_f) <= std::max(1e-6, 5.0 * error);
}

std::vector<Basin> find_basins(const SweepPoint& point, const BasinSettings& settings) {
  std::vector<Basin> basins;
  const int starts = settings.given.empty() ? settings.starts : static_cast<int>(settings.given.size());
  for (int i = 0; i < starts; ++i) {
    const Visit v = visit(point, static_cast<std::uint64_t>(i), settings);
    const auto known =
        std::find_if(basins.begin(), basins.end(), [&](const Basin& basin) { return same_attractor(basin.first, v); });
    if (known == basins.end()) {
      basins.push_back({v, {i}, 0.0, 0.0});
    } else {
      known->starts.push_back(i);
    }
  }
  for (Basin& basin : basins) {
    basin.share = static_cast<double>(basin.starts.size()) / starts;
    basin.share_std_error = std::sqrt(basin.share * (1.0 - basin.share) / starts);
  }
  std::stable_sort(basins.begin(), basins.end(), [](const Basin& a, const Basin& b) { return a.share > b.share; });
  return basins;
}

}  // namespace afm
