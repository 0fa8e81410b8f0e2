// Curves, attractors, orbits, exponents, flights: what the tools of these names compute.
#include <pybind11/stl.h>

#include <algorithm>
#include <atomic>
#include <iterator>
#include <limits>
#include <string>
#include <type_traits>
#include <vector>

#include "afm/dynamics/basins.h"
#include "afm/dynamics/interruption.h"
#include "afm/dynamics/lyapunov.h"
#include "afm/dynamics/orbit_search.h"
#include "afm/single_flight.h"
#include "convert.h"
#include "long_call.h"
#include "sweep/curve_points.h"
#include "sweep/grid.h"
#include "sweep/rows.h"

namespace afm::python {
namespace {

using namespace py::literals;
using Numbers = py::array_t<double, py::array::c_style | py::array::forcecast>;

// Takes the cells of rows, as TableWriter does: numbers, and the one column of text that some tables have.
class Rows {
 public:
  Rows& operator<<(double value) {
    numbers_.push_back(value);
    return *this;
  }
  template <class Whole, class = std::enable_if_t<std::is_integral<Whole>::value>>
  Rows& operator<<(Whole value) {
    return *this << static_cast<double>(value);
  }
  Rows& operator<<(const std::string& text) {
    names_.push_back(text);
    return *this;
  }
  void end_row() { ++rows_; }

  py::tuple result(const std::vector<Column>& columns) const {
    const std::size_t width = columns.size() - (names_.empty() ? 0 : 1);
    py::array_t<double> matrix(
        std::vector<py::ssize_t>{static_cast<py::ssize_t>(rows_), static_cast<py::ssize_t>(width)});
    std::copy(numbers_.begin(), numbers_.end(), matrix.mutable_data());
    std::vector<std::string> header;
    for (const Column& column : columns) header.push_back(column.name);
    return py::make_tuple(header, matrix, names_);
  }

 private:
  std::vector<double> numbers_;
  std::vector<std::string> names_;
  std::size_t rows_ = 0;
};

void check_axes(const CurveSettings& s) {
  const auto check = [](const char* name, const std::vector<double>& axis) {
    require(!axis.empty(), name, 0.0, "must hold at least one number");
  };
  check("eta", s.eta);
  check("gamma", s.gamma);
  check("cutoff", s.cutoff);
  check("rest_height", s.rest_height);
  check("amplitude", s.amplitude);
  check("frequency_ratio", s.frequency_ratio);
}

SweepDirection direction_of(const std::string& name) {
  if (name == "fresh") return SweepDirection::fresh;
  if (name == "up") return SweepDirection::up;
  if (name == "down") return SweepDirection::down;
  throw py::value_error("sweep = " + name + ": must be fresh, up or down");
}

// Of axes (eta, gamma, cutoff, rest_height, amplitude, frequency_ratio).
py::tuple friction_curve(const std::vector<std::vector<double>>& axes, const std::string& kind,
                         const std::string& sweep, double duration, double transient, const Bath& bath,
                         std::uint64_t seed, int threads, const py::object& progress) {
  CurveSettings s{axes.at(0), axes.at(1),          axes.at(2),    axes.at(3), axes.at(4),
                  axes.at(5), direction_of(sweep), kind_of(kind), {}};
  s.sweep.duration = duration;
  s.sweep.transient = transient;
  s.sweep.bath = bath;
  s.sweep.seed = s.sweep.bath.seed = seed;
  check_axes(s);
  refuse(find_faults(s));
  const SweepGrid grid(s);
  CurvePoints points(grid, s.sweep);
  std::size_t done = 0;
  Rows rows;
  const auto watch = [&] {
    for (const SweepResult& result : points.collect(std::chrono::milliseconds(0)))
      write_row(grid.at(done++), result, rows);
    if (!progress.is_none()) progress(done, grid.size());
  };
  run_on_threads(
      threads, [&] { points.work(); }, watch);
  return rows.result(curve_columns());
}

// Of each start at each point the point, its attractor (a row of the table), and the start.
py::array labels(const std::vector<SweepPoint>& grid, const std::vector<std::vector<Basin>>& basins,
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
  return std::move(table);
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
  Rows rows;
  for (std::size_t i = 0; i < grid.size(); ++i) {
    for (const Basin& basin : basins[i]) write_row(grid[i], basin, rows);
  }
  return rows.result(basin_columns()) + py::make_tuple(labels(grid, basins, settings));
}

void check_eta(double eta, bool may_be_zero) {
  require(std::abs(eta) <= kMaxEta, "eta", eta, "must be finite and at most 1000 lattice spacings per tau");
  require(may_be_zero || eta != 0.0, "eta", eta, "without drag there is no orbit but rest");
}

py::tuple periodic_orbits(const Model& model, double eta, int max_length, int trajectory, int guesses,
                          std::uint64_t seed) {
  check_eta(eta, false);
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
  Rows rows;
  for (const FoundOrbit& orbit : found.orbits) write_row(model.H, orbit.orbit, rows);
  return rows.result(orbit_columns());
}

const char* name_of(LyapunovOutcome outcome) {
  switch (outcome) {
    case LyapunovOutcome::measured:
      return "measured";
    case LyapunovOutcome::budget_spent:
      return "budget_spent";
    case LyapunovOutcome::no_event:
      return "no_event";
    case LyapunovOutcome::search_failed:
      return "search_failed";
    default:
      return "no_number";
  }
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

// Of rows of (eta, gamma, cutoff, phase, extension, u, w, rest_height, amplitude, frequency_ratio). Returns the eight
// results of each, one row after the other, NaN where it has none, and what is wrong with the first such row: its number and the fault.
py::tuple next_impact(const Numbers& inputs, const std::string& kind, int threads) {
  constexpr std::size_t kInputs = 10, kResults = 8, kRowsAtATime = 1000;
  const std::size_t n = static_cast<std::size_t>(inputs.size()) / kInputs;
  const ModelKind model = kind_of(kind);
  const double* in = inputs.data();
  std::vector<double> results(n * kResults, std::numeric_limits<double>::quiet_NaN());
  std::vector<std::string> faults(n);
  std::atomic<std::size_t> next{0};
  const auto compute = [&](std::size_t i) {
    const double* x = in + i * kInputs;
    const FlightInput input{x[0], x[1], x[2], x[3], x[4], x[5], x[6], model, x[7], x[8], x[9]};
    try {
      const FlightResult r = fly_to_next_impact(input);
      const double row[] = {r.dt, r.phase, r.extension, r.u, r.w, r.normal_speed, r.tangential_velocity, r.energy_loss};
      std::copy(std::begin(row), std::end(row), &results[i * kResults]);
    } catch (const std::exception& fault) {
      faults[i] = fault.what();
    }
  };
  run_on_threads(threads, [&] {
    for (std::size_t from; (from = next.fetch_add(kRowsAtATime)) < n;) {
      interruption_point();
      for (std::size_t i = from; i < std::min(n, from + kRowsAtATime); ++i) compute(i);
    }
  });
  const auto first =
      std::find_if(faults.begin(), faults.end(), [](const std::string& fault) { return !fault.empty(); });
  const py::array array = to_array(std::move(results));
  if (first == faults.end()) return py::make_tuple(array, py::none());
  return py::make_tuple(array, py::make_tuple(first - faults.begin(), *first));
}

// Throws ParameterError for one row that next_impact() could not compute, where an argument is at fault.
void check_flight(const Numbers& row, const std::string& kind) {
  const double* x = row.data();
  refuse(find_faults(FlightInput{x[0], x[1], x[2], x[3], x[4], x[5], x[6], kind_of(kind), x[7], x[8], x[9]}));
}

}  // namespace

void add_tables(py::module& m) {
  m.attr("VERSION") = AFM_EMULATOR_VERSION;
  m.def("friction_curve", &friction_curve);
  m.def("attractors", &attractors);
  m.def("periodic_orbits", &periodic_orbits);
  m.def("lyapunov", &exponents);
  m.def("next_impact", &next_impact);
  m.def("check_flight", &check_flight);
}

}  // namespace afm::python
