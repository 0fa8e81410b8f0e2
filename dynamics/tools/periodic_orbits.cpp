// The periodic orbits at given parameters.
#include <fstream>
#include <iostream>
#include <string>
#include <vector>

#include "afm/dynamics/cycle_expansion.h"
#include "afm/dynamics/orbit_search.h"
#include "common/point_options.h"
#include "common/progress_bar.h"
#include "common/table_writer.h"
#include "study_rows.h"

namespace {

const char kDescription[] =
    "Finds the periodic orbits of the map from impact to impact, stable or not, and prints a row for each (units\n"
    "a, tau, tip mass): impacts and cells in a period, period, K_f, residual (the largest error of any coordinate\n"
    "over a flight), the first point just after an impact (surface phase, extension, lab velocity), and the four\n"
    "multipliers, largest first. What speaks for there being no more goes to stderr: how often each length was\n"
    "found, and how near the long run comes to each orbit.";

using Q = afm::Quantity;

const std::vector<afm::Column> kAverageColumns{
    {"method"}, {"order"}, {"terms"}, {"k_f", Q::friction}, {"conservation"}};

struct Options {
  afm::PointOptions dynamics;
  afm::OrbitSearchSettings search;
  bool quiet = false;
  std::string averages;
};

void add_options(afm::CommandLine& app, Options& o) {
  afm::add_options(app, o.dynamics);
  afm::add_si_options(app, o.dynamics);
  app.option("max-length", o.search.longest, "longest orbit looked for [impacts]", {1, 32});
  app.option("trajectory", o.search.trajectory, "impacts of the long run that guesses are taken from",
             {1000, 10000000});
  app.option("guesses", o.search.guesses, "of each of three kinds, for each length", {1, 1000000});
  app.option("seed", o.search.seed, "of what is random in the search");
  app.option(
      "averages", o.averages,
      "file for K_f from these orbits by periodic orbit theory: method, order of truncation, terms, K_f, and by how\n"
      "much the expansion misses the conservation of flow; without orbits that the long run stays away from");
  app.flag("quiet", o.quiet, "no report of the search on stderr");
}

void report(const afm::OrbitSearchResult& found, const afm::TableUnits& units) {
  const std::string K_f = units.name({"K_f", Q::friction});
  for (const afm::LengthReport& length : found.lengths) {
    std::cerr << "length " << length.length << ": of " << length.prime + length.repeats + length.none << " guesses "
              << length.prime << " led to prime orbits, " << length.repeats << " to repeats of shorter ones, "
              << length.none << " nowhere; nearest return of the run " << length.closest_return
              << "; orbits missed, estimated: " << length.missed << "\n";
    for (const afm::FoundOrbit& orbit : found.orbits) {
      if (orbit.orbit.length() != static_cast<std::size_t>(length.length)) continue;
      std::cerr << "  " << K_f << " " << units.convert(Q::friction, orbit.orbit.K_f) << ": found " << orbit.times_found
                << " times, the run comes within " << orbit.approach << "\n";
    }
  }
}

void write_rows(afm::TableWriter& to, const std::string& method, const std::vector<afm::CycleAverage>& rows) {
  for (const afm::CycleAverage& row : rows) {
    to << method << row.order << row.terms << row.K_f << row.conservation;
    to.end_row();
  }
}

void write_averages(const Options& options, const afm::OrbitSearchResult& found) {
  std::ofstream out(options.averages);
  std::vector<afm::PeriodicOrbit> orbits;
  constexpr double kOnAttractor = 0.1;  // [a, a/tau] a choice: orbits that the long run does not approach are left out
  for (const afm::FoundOrbit& orbit : found.orbits) {
    if (orbit.approach < kOnAttractor) orbits.push_back(orbit.orbit);
  }
  const double eta = options.dynamics.eta;
  afm::TableWriter to(out, kAverageColumns, afm::table_units(options.dynamics.si));
  to.write_header();
  write_rows(to, "zeta", zeta_averages(orbits, eta, options.search.longest));
  write_rows(to, "determinant", determinant_averages(orbits, eta, options.search.longest));
  out.close();
  if (!out) throw std::runtime_error("cannot write " + options.averages);
}

int run(const afm::CommandLine& app, Options& options) {
  take_si(app, options.dynamics);
  const afm::Model model = checked_model(options.dynamics);
  if (options.dynamics.eta == 0.0) throw std::invalid_argument("eta = 0: without drag there is no orbit but rest");
  afm::check_writable(options.averages);
  constexpr std::size_t kSteps = 1000;
  afm::ProgressBar bar(kSteps, 0);
  const auto show = [&](double share) { bar.show(static_cast<std::size_t>(share * kSteps)); };
  const auto found = search_orbits(afm::PoincareMap(model, options.dynamics.eta), options.search, show);
  afm::TableWriter table(std::cout, afm::kOrbitColumns, afm::table_units(options.dynamics.si));
  table.write_header();
  for (const afm::FoundOrbit& orbit : found.orbits) write_row(model.H, orbit.orbit, table);
  if (!options.averages.empty()) write_averages(options, found);
  if (!options.quiet) report(found, afm::table_units(options.dynamics.si));
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  afm::CommandLine app("periodic_orbits", kDescription);
  Options options;
  add_options(app, options);
  return app.run(argc, argv, [&] { return run(app, options); });
}
