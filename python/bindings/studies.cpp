// Attractors, orbits, exponents: what the tools of the laboratory compute.
#include <pybind11/stl.h>

#include <algorithm>
#include <atomic>
#include <iterator>
#include <string>
#include <vector>

#include "afm/dynamics/basins.h"
#include "afm/dynamics/lyapunov.h"
#include "afm/dynamics/orbit_search.h"
#include "convert.h"
#include "long_call.h"
#include "study_rows.h"
#include "table_rows.h"

namespace afm::python {
namespace {

// For each start at each point: the point, its attractor (a row of the table), and the start.
py::array_t<double> labels(const std::vector<SweepPoint>& grid, const std::vector<std::vector<Basin>>& basins,
                           const BasinSettings& settings) {
  constexpr std::size_t kColumns = 7;
  const auto starts = static_cast<std::size_t>(settings.starts);
  py::array_t<double> table(std::vector<std::size_t>{grid.size() * starts, kColumns});
  double attractor = 0.0;
  for (std::size_t i = 0; i < grid.size(); ++i) {
    for (const Basin& basin : basins[i]) {
      for (const int start : basin.starts) {
        const auto n = static_cast<std::size_t>(start);
        const FreeState s = to_free_state(grid[i].H, start_of(grid[i], n, settings));
        const double row[] = {static_cast<double>(i), attractor, s.phase, s.X, s.y, s.u, s.w};
        std::copy(std::begin(row), std::end(row), table.mutable_data() + (i * starts + n) * kColumns);
      }
      ++attractor;
    }
  }
  return table;
}

// At every point (eta, gamma, cutoff, rest_height, amplitude, frequency_ratio). Given starts are rows of (phase,
// extension, y, u, w).
py::tuple attractors(const std::vector<std::vector<double>>& points, const std::string& kind, int starts,
                     const std::vector<std::vector<double>>& given, std::uint64_t seed, double transient,
                     double duration, double friction_duration, int threads) {
  BasinSettings settings;
  settings.starts = given.empty() ? starts : static_cast<int>(given.size());
  settings.seed = seed;
  settings.friction_duration = friction_duration;
  settings.attractor.transient = transient;
  settings.attractor.duration = duration;
  require(starts >= 1, "starts", starts, "must be at least 1");
  require(transient >= 0.0 && transient <= 1e9, "transient", transient, "must be within 0 and 1e9 tau");
  require(duration >= 1.0 && duration <= 1e9, "duration", duration, "must be within 1 and 1e9 tau");
  require(friction_duration >= 1.0 && friction_duration <= 1e9, "friction_duration", friction_duration,
          "must be within 1 and 1e9 tau");
  std::vector<SweepPoint> grid;
  for (const std::vector<double>& p : points) {
    grid.push_back({p.at(0), p.at(1), p.at(2), kind_of(kind), p.at(3), p.at(4), p.at(5)});
    refuse(find_faults(grid.back()));
    warn(find_short_drag("transient", transient, grid.back().eta, 1.0));
  }
  for (const std::vector<double>& g : given) {
    const FreeState start{g.at(0), g.at(1), g.at(2), g.at(3), g.at(4)};
    for (const SweepPoint& point : grid) {
      RunSettings run;
      run.model = model_of(point);
      run.eta = point.eta;
      run.initial = start;
      refuse(find_faults(run));
    }
    settings.given.push_back(start);
  }
  std::vector<std::vector<Basin>> basins(grid.size());
  std::atomic<std::size_t> next{0};
  run_on_threads(threads, [&] {
    for (std::size_t i; (i = next++) < grid.size();) basins[i] = find_basins(grid[i], settings);
  });
  TableRows rows;
  for (std::size_t i = 0; i < grid.size(); ++i) {
    for (const Basin& basin : basins[i]) write_row(grid[i], basin, rows);
  }
  return rows.result(kBasinColumns) + py::make_tuple(labels(grid, basins, settings));
}

py::tuple periodic_orbits(const Model& model, double eta, int max_length, int trajectory, int guesses,
                          std::uint64_t seed) {
  check_eta(eta);
  require(eta != 0.0, "eta", eta, "without drag there is no orbit but rest");
  require(max_length >= 1 && max_length <= 32, "max_length", max_length, "must be within 1 and 32");
  require(trajectory >= 1000 && trajectory <= 10000000, "trajectory", trajectory, "must be within 1000 and 10000000");
  require(guesses >= 1 && guesses <= 1000000, "guesses", guesses, "must be within 1 and 1000000");
  OrbitSearchSettings settings;
  settings.longest = max_length;
  settings.trajectory = trajectory;
  settings.guesses = guesses;
  settings.seed = seed;
  OrbitSearchResult found;
  run_on_threads(1, [&] { found = search_orbits(PoincareMap(model, eta), settings); });
  TableRows rows;
  for (const FoundOrbit& orbit : found.orbits) write_row(model.H, orbit.orbit, rows);
  return rows.result(kOrbitColumns);
}

const char* name_of(LyapunovOutcome outcome) {
  constexpr const char* kNames[] = {"measured", "budget_spent", "no_event", "search_failed", "no_number"};
  return kNames[static_cast<std::size_t>(outcome)];  // in the order of LyapunovOutcome
}

py::object exponents(const Model& model, double eta, double phase, double extension, double y, const py::object& u,
                     double w, double transient, double duration, std::uint64_t most_events, double contact_tolerance) {
  const RunSettings start = to_settings(model, eta, phase, extension, y, u, w, contact_tolerance);
  refuse(find_faults(start));
  require(transient >= 0.0 && transient <= 1e12, "transient", transient, "must be within 0 and 1e12 tau");
  require(duration > 0.0 && duration <= 1e12, "duration", duration, "must be above 0 and at most 1e12 tau");
  LyapunovSpectrum s;
  run_on_threads(1, [&] {
    s = lyapunov(model, eta, start.initial, LyapunovSettings{transient, duration, most_events, contact_tolerance});
  });
  const auto array = [](const std::array<double, 4>& four) {
    return to_array(std::vector<double>(four.begin(), four.end()));
  };
  return py::module::import("afm.values")
      .attr("Lyapunov")(array(s.exponents), array(s.std_errors), name_of(s.outcome), s.rank, s.volume_rate, s.duration,
                        s.events);
}

}  // namespace

void add_studies(py::module& m) {
  m.def("attractors", &attractors);
  m.def("periodic_orbits", &periodic_orbits);
  m.def("lyapunov", &exponents);
}

}  // namespace afm::python
