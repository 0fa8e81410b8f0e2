// The periodic orbits at given parameters.
#include <algorithm>
#include <cmath>
#include <fstream>
#include <iostream>
#include <string>
#include <vector>

#include "afm/dynamics/cycle_expansion.h"
#include "afm/dynamics/orbit_search.h"
#include "afm/state.h"
#include "common/csv.h"
#include "dynamics_options.h"
#include "common/progress_bar.h"

namespace {

const char kDescription[] =
    "Finds the periodic orbits of the map from impact to impact, stable or not, and prints a row for each (units\n"
    "a, tau, tip mass): impacts and cells in a period, period, K_f, residual (the largest error of any coordinate\n"
    "over a flight), the first point just after an impact (surface phase, extension, lab velocity), and the four\n"
    "multipliers, largest first. What speaks for there being no more goes to stderr: how often each length was\n"
    "found, and how near the long run comes to each orbit.";

const char kHeader[] =
    "length,cells,period,k_f,residual,phase,extension,u,w,multiplier_1_re,multiplier_1_im,multiplier_2_re,multiplier_2_"
    "im,"
    "multiplier_3_re,multiplier_3_im,multiplier_4_re,multiplier_4_im";

struct Options {
  afm::DynamicsOptions dynamics;
  afm::OrbitSearchSettings search;
  bool quiet = false;
  std::string averages;
  double attractor_distance = 0.1;
};

void add_options(afm::CommandLine& app, Options& o) {
  afm::add_options(app, o.dynamics);
  app.option("max-length", o.search.longest, "longest orbit looked for [impacts]", {1, 32});
  app.option("trajectory", o.search.trajectory, "impacts of the long run that guesses are taken from",
             {1000, 10000000});
  app.option("guesses", o.search.guesses, "of each of three kinds, for each length", {1, 1000000});
  app.option("seed", o.search.seed, "of what is random in the search");
  app.option(
      "averages", o.averages,
      "file for K_f from these orbits by periodic orbit theory: method, order of truncation, terms, K_f, and by how\n"
      "much the expansion misses the conservation of flow");
  app.option("attractor-distance", o.attractor_distance,
             "orbits that the long run does not approach so far are not of the attractor: left out of the averages");
  app.flag("quiet", o.quiet, "no report of the search on stderr");
}

void print_row(double H, const afm::PeriodicOrbit& orbit) {
  const afm::FreeState first = to_free_state(H, orbit.points.front());
  std::vector<double> row{static_cast<double>(orbit.length()),
                          static_cast<double>(orbit.cells),
                          orbit.period,
                          orbit.K_f,
                          orbit.residual,
                          first.phase,
                          first.X,
                          first.u,
                          first.w};
  for (const std::complex<double>& multiplier : orbit.multipliers) {
    row.push_back(multiplier.real());
    row.push_back(multiplier.imag());
  }
  std::cout << afm::join_numbers(row) << "\n";
}

void report(const afm::OrbitSearchResult& found) {
  for (const afm::LengthReport& length : found.lengths) {
    std::cerr << "length " << length.length << ": of " << length.prime + length.repeats + length.none << " guesses "
              << length.prime << " led to prime orbits, " << length.repeats << " to repeats of shorter ones, "
              << length.none << " nowhere; nearest return of the run " << length.closest_return
              << "; orbits missed, estimated: " << length.missed << "\n";
    for (const afm::FoundOrbit& orbit : found.orbits) {
      if (orbit.orbit.length() != static_cast<std::size_t>(length.length)) continue;
      std::cerr << "  K_f " << orbit.orbit.K_f << ": found " << orbit.times_found << " times, the run comes within "
                << orbit.approach << "\n";
    }
  }
}

void write_rows(std::ostream& out, const std::string& method, const std::vector<afm::CycleAverage>& rows) {
  for (const afm::CycleAverage& row : rows) {
    out << method << "," << afm::join_numbers({row.order, static_cast<double>(row.terms), row.K_f, row.conservation})
        << "\n";
  }
}

void write_averages(const Options& options, const afm::OrbitSearchResult& found) {
  std::ofstream out(options.averages);
  std::vector<afm::PeriodicOrbit> orbits;
  for (const afm::FoundOrbit& orbit : found.orbits) {
    if (orbit.approach < options.attractor_distance) orbits.push_back(orbit.orbit);
  }
  const double eta = options.dynamics.eta;
  out << "method,order,terms,k_f,conservation\n";
  write_rows(out, "zeta", zeta_averages(orbits, eta, options.search.longest));
  write_rows(out, "determinant", determinant_averages(orbits, eta, options.search.longest));
  constexpr double kMostUnstable = 1e3;
  std::vector<afm::CycleAverage> by_stability = stability_averages(orbits, eta, kMostUnstable);
  constexpr std::size_t kMostRows = 1000;
  by_stability.resize(std::min(by_stability.size(), kMostRows));
  write_rows(out, "stability", by_stability);
  out.close();
  if (!out) throw std::runtime_error("cannot write " + options.averages);
}

int run(const Options& options) {
  const afm::Model model = checked_model(options.dynamics);
  if (options.dynamics.eta == 0.0) throw std::invalid_argument("eta = 0: without drag there is no orbit but rest");
  constexpr std::size_t kSteps = 1000;
  afm::ProgressBar bar(kSteps, 0);
  const auto show = [&](double share) { bar.show(static_cast<std::size_t>(share * kSteps)); };
  const auto found = search_orbits(afm::PoincareMap(model, options.dynamics.eta), options.search, show);
  std::cout << kHeader << "\n";
  for (const afm::FoundOrbit& orbit : found.orbits) print_row(model.H, orbit.orbit);
  if (!options.averages.empty()) write_averages(options, found);
  if (!options.quiet) report(found);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  afm::CommandLine app("periodic_orbits", kDescription);
  Options options;
  add_options(app, options);
  return app.run(argc, argv, [&] { return run(options); });
}
