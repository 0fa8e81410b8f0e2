// Curves and flights: what the tools of these names compute.
#include <pybind11/stl.h>

#include <algorithm>
#include <atomic>
#include <iterator>
#include <limits>
#include <string>
#include <vector>

#ifdef AFM_DYNAMICS
#include "afm/dynamics/sweep.h"
#endif
#include "afm/fingerprint.h"
#include "afm/interruption.h"
#include "afm/single_flight.h"
#include "convert.h"
#include "long_call.h"
#include "sweep/grid.h"
#include "sweep/rows.h"
#include "table_rows.h"

namespace afm::python {
namespace {

using namespace py::literals;
using Numbers = py::array_t<double, py::array::c_style | py::array::forcecast>;

// The curve over the axes (eta, gamma, cutoff, rest_height, amplitude, frequency_ratio).
py::tuple friction_curve(const std::vector<std::vector<double>>& axes, const std::string& kind,
                         const std::string& sweep, double duration, double transient, const Bath& bath,
                         std::uint64_t seed, int threads, const py::object& progress) {
  CurveSettings s{axes.at(0), axes.at(1), axes.at(2), axes.at(3), axes.at(4), axes.at(5), {}, kind_of(kind), {}};
  if (!parse(sweep, s.direction)) refuse_word("sweep", sweep, "must be fresh, up or down");
#ifdef AFM_DYNAMICS
  s.method = sweep_attractor;
#endif
  s.sweep.duration = duration;
  s.sweep.transient = transient;
  s.sweep.bath = bath;
  s.sweep.seed = s.sweep.bath.seed = seed;
  refuse(find_faults(s));
  warn(find_warnings(s));
  std::vector<std::vector<SweepResult>> chains(s.size() / s.chain_length());
  std::atomic<std::size_t> next{0}, done{0};
  const auto work = [&] {
    for (std::size_t i; (i = next++) < chains.size();) chains[i] = compute_chain(s, i * s.chain_length(), done);
  };
  const auto watch = [&] {
    if (!progress.is_none()) progress(done.load(), s.size());
  };
  run_on_threads(threads, work, watch);
  TableRows rows;
  std::size_t row = 0;
  std::uint64_t failures = 0;
  for (const std::vector<SweepResult>& chain : chains) {
    for (const SweepResult& result : chain) {
      write_row(s.at(row++), result, rows);
      failures += result.friction.search_failures;
    }
  }
  if (failures > 0) warn("the search of an impact failed " + std::to_string(failures) + " times");
  return rows.result(kCurveColumns);
}

// A row of the input is (eta, gamma, cutoff, phase, extension, u, w, rest_height, amplitude, frequency_ratio). Returns
// the eight results of each row, NaN where it has none; where `raises` is set, the first such row is an error.
py::array next_impact(const Numbers& inputs, const std::string& kind, bool raises, int threads) {
  constexpr std::size_t kInputs = 10, kResults = 8, kRowsAtATime = 1000;
  const std::size_t n = static_cast<std::size_t>(inputs.size()) / kInputs;
  const ModelKind model = kind_of(kind);
  const double* in = inputs.data();
  std::vector<double> results(n * kResults, std::numeric_limits<double>::quiet_NaN());
  std::vector<std::string> faults(n);
  std::atomic<std::size_t> next{0};
  const auto input_of = [&](std::size_t i) {
    const double* x = in + i * kInputs;
    return FlightInput{x[0], x[1], x[2], x[3], x[4], x[5], x[6], model, x[7], x[8], x[9]};
  };
  const auto compute = [&](std::size_t i) {
    try {
      const FlightResult r = fly_to_next_impact(input_of(i));
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
  for (std::size_t i = 0; i < n && raises; ++i) {
    if (faults[i].empty()) continue;
    refuse(find_faults(input_of(i)));  // where an argument is at fault
    throw py::value_error("state " + std::to_string(i) + ": " + faults[i]);
  }
  return to_array(std::move(results));
}

}  // namespace

void add_tables(py::module& m) {
  m.attr("VERSION") = AFM_EMULATOR_VERSION;
  m.def("arithmetic_fingerprint", &arithmetic_fingerprint);
  m.def("friction_curve", &friction_curve);
  m.def("next_impact", &next_impact);
  m.def("check_point_count", [](double points) { refuse(find_point_count_fault(points)); });
}

}  // namespace afm::python
