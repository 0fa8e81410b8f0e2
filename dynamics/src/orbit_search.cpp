#include "afm/dynamics/orbit_search.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <random>

#include "afm/interruption.h"

namespace afm {
namespace {

using Points = std::vector<TipState>;
using Random = std::mt19937_64;

double within(Random& random, double low, double high) {
  return low + (high - low) * (static_cast<double>(random() >> 11) * 0x1p-53);
}

// A random state after an impact, with velocities of the order of the drag velocity.
TipState anywhere(const PoincareMap& map, Random& random) {
  const double speed = 1.0 + std::abs(map.eta());
  return {within(random, 0.0, 1.0), within(random, -0.1, 0.1), map.eta() + within(random, -1.0, 1.0) * speed, 0.0,
          within(random, 0.0, 2.0) * speed};
}

// A run of impacts. After contact, which this map does not cover, it restarts at random.
Points run(const PoincareMap& map, std::size_t impacts, Random& random) {
  Points points;
  TipState now = anywhere(map, random);
  while (points.size() < impacts) {
    interruption_point();
    const MapStep step = map(now);
    now = step.outcome == MapOutcome::impact ? step.after : anywhere(map, random);
    points.push_back(now);
  }
  return points;
}

// Indices of the nearest returns of the run after n impacts, nearest first.
std::vector<std::size_t> returns(const Points& points, std::size_t n, std::size_t wanted, double& nearest) {
  std::vector<std::pair<double, std::size_t>> distances;
  for (std::size_t i = 0; i + n < points.size(); ++i) {
    distances.emplace_back(section_difference(points[i + n], points[i]).norm(), i);
  }
  wanted = std::min(wanted, distances.size());
  std::partial_sort(distances.begin(), distances.begin() + static_cast<std::ptrdiff_t>(wanted), distances.end());
  nearest = distances.front().first;
  std::vector<std::size_t> indices;
  for (std::size_t i = 0; i < wanted; ++i) indices.push_back(distances[i].second);
  return indices;
}

class Search {
 public:
  Search(const PoincareMap& map, const OrbitSearchSettings& settings, const std::function<void(double)>& progress)
      : map_(map), settings_(settings), progress_(progress), random_(settings.seed) {
    constexpr std::size_t kTransientImpacts = 1000;  // a choice
    run_ = run(map, static_cast<std::size_t>(std::max(settings.trajectory, settings.longest + 1)) + kTransientImpacts,
               random_);
    run_.erase(run_.begin(), run_.begin() + kTransientImpacts);
  }

  OrbitSearchResult all() {
    for (int n = 1; n <= settings_.longest; ++n) search_length(static_cast<std::size_t>(n));
    return std::move(result_);
  }

 private:
  void search_length(std::size_t n) {
    report_ = {static_cast<int>(n), 0, 0, 0, 0.0, 0.0};
    found_.clear();
    for (const std::size_t i : returns(run_, n, static_cast<std::size_t>(settings_.guesses), report_.closest_return)) {
      attempt(part(run_, i, n));
    }
    for (int k = 0; k < settings_.guesses; ++k) attempt(part(run_, random_() % (run_.size() - n), n));
    for (int k = 0; k < settings_.guesses; ++k) attempt(run(map_, n, random_));
    close_length();
  }

  static Points part(const Points& run, std::size_t from, std::size_t n) {
    const auto begin = run.begin() + static_cast<std::ptrdiff_t>(from);
    return Points(begin, begin + static_cast<std::ptrdiff_t>(n));
  }

  void attempt(const Points& guess) {
    interruption_point();
    const OrbitResult r = find_orbit(map_, guess);
    const double share = static_cast<double>(++attempts_) / (3.0 * settings_.guesses * settings_.longest);
    if (progress_) progress_(share);
    if (r.outcome != OrbitOutcome::found) {
      ++report_.none;
    } else if (!is_prime(r.orbit)) {
      ++report_.repeats;
    } else {
      ++report_.prime;
      keep(r.orbit);
    }
  }

  void keep(const PeriodicOrbit& orbit) {
    for (FoundOrbit& known : found_) {
      if (same_orbit(known.orbit, orbit)) {
        ++known.times_found;
        return;
      }
    }
    found_.push_back({orbit, 1, approach(orbit.points.front())});
  }

  double approach(const TipState& point) const {
    double nearest = std::numeric_limits<double>::infinity();
    for (const TipState& q : run_) nearest = std::min(nearest, section_difference(q, point).norm());
    return nearest;
  }

  void close_length() {
    double once = 0.0, twice = 0.0;
    for (const FoundOrbit& f : found_) (f.times_found == 1 ? once : twice) += f.times_found <= 2 ? 1.0 : 0.0;
    report_.missed = once > 0.0 ? once * (once - 1.0) / (2.0 * (twice + 1.0)) : 0.0;
    std::sort(found_.begin(), found_.end(),
              [](const FoundOrbit& a, const FoundOrbit& b) { return a.orbit.K_f < b.orbit.K_f; });
    std::move(found_.begin(), found_.end(), std::back_inserter(result_.orbits));
    result_.lengths.push_back(report_);
  }

  const PoincareMap& map_;
  const OrbitSearchSettings& settings_;
  const std::function<void(double)>& progress_;
  Random random_;
  Points run_;
  LengthReport report_;
  std::vector<FoundOrbit> found_;
  OrbitSearchResult result_;
  std::int64_t attempts_ = 0;
};

}  // namespace

OrbitSearchResult search_orbits(const PoincareMap& map, const OrbitSearchSettings& settings,
                                const std::function<void(double)>& progress) {
  return Search(map, settings, progress).all();
}

}  // namespace afm
