// Periodic orbits followed through a parameter.
#include <iostream>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

#include "afm/dynamics/continuation.h"
#include "afm/dynamics/orbit_search.h"
#include "common/point_options.h"
#include "common/table_writer.h"
#include "study_rows.h"

namespace {

const char kDescription[] =
    "Finds the periodic orbits at given parameters and follows each through one of them, round folds, to a target\n"
    "or to where it ends. Rows: number of the orbit, the value of the parameter, what happens there (empty, a\n"
    "bifurcation, or how the branch ends), impacts and cells in a period, K_f, the slowest impact, the smallest\n"
    "gap on the way (inf: none), and the multipliers.";

using Q = afm::Quantity;

// The second column holds the parameter that is followed.
std::vector<afm::Column> columns(const std::string& vary) {
  return afm::with_multipliers({{"orbit"},
                                {"value", vary == "gamma" ? Q::number : Q::velocity},
                                {"event"},
                                {"length"},
                                {"cells"},
                                {"k_f", Q::friction},
                                {"slowest_impact", Q::velocity},
                                {"clearance", Q::length}});
}

struct Varied {
  afm::Parameter parameter;
  double afm::PointOptions::*option;
};

const std::map<std::string, Varied> kVaried{{"eta", {afm::Parameter::eta, &afm::PointOptions::eta}},
                                            {"gamma", {afm::Parameter::gamma, &afm::PointOptions::gamma}},
                                            {"cutoff", {afm::Parameter::cutoff, &afm::PointOptions::cutoff}}};

const std::map<afm::BranchEnd, std::string> kEnds{
    {afm::BranchEnd::target, "end: target"},
    {afm::BranchEnd::grazing, "end: grazing"},
    {afm::BranchEnd::period_doubling, "end: period doubling"},
    {afm::BranchEnd::resonance, "end: resonance of the horizontal spring"},
    {afm::BranchEnd::lost, "end: lost"},
    {afm::BranchEnd::steps_spent, "end: steps spent"}};

struct Options {
  afm::PointOptions dynamics;
  afm::OrbitSearchSettings search;
  std::string vary = "eta";
  double to = 0.0;
  int length = 1;
};

void add_options(afm::CommandLine& app, Options& o) {
  o.search.trajectory = 50000;
  o.search.guesses = 500;
  afm::add_options(app, o.dynamics);
  afm::add_si_options(app, o.dynamics);
  app.option("vary", o.vary, "eta, gamma or cutoff");
  app.option("to", o.to, "value to go to; with --si a drag velocity or cutoff in m/s");
  app.option("length", o.length, "of the orbits followed [impacts]", {1, 32});
  app.option("guesses", o.search.guesses, "of the search, of each kind", {1, 1000000});
  app.option("seed", o.search.seed, "of what is random in the search");
}

void print_row(int number, const afm::BranchPoint& point, const std::string& event, afm::TableWriter& to) {
  const afm::PeriodicOrbit& orbit = point.orbit;
  to << number << point.parameter << event << orbit.length() << orbit.cells << orbit.K_f << orbit.slowest_impact
     << orbit.clearance;
  afm::write_multipliers(orbit, to);
  to.end_row();
}

void print(int number, const afm::Branch& branch, afm::TableWriter& to) {
  for (const afm::BranchPoint& point : branch.points) print_row(number, point, "", to);
  for (const afm::BranchEvent& event : branch.events) print_row(number, event.at, name(event.kind), to);
  print_row(number, branch.points.back(), kEnds.at(branch.end), to);
}

const Varied& varied(const std::string& vary) {
  const auto found = kVaried.find(vary);
  if (found == kVaried.end()) throw std::invalid_argument("vary = " + vary + ": must be eta, gamma or cutoff");
  return found->second;
}

void check_target(const afm::CommandLine& app, const Options& options) {
  afm::PointOptions at = options.dynamics;
  at.*varied(options.vary).option = options.to;
  std::vector<afm::ParameterError> faults = find_faults(at);
  for (afm::ParameterError& fault : faults) {
    if (fault.name == options.vary) fault = afm::ParameterError("to", fault.value, fault.reason);
  }
  if (options.vary != "gamma") faults = as_given(app, at.si, faults);
  if (!faults.empty()) throw std::invalid_argument(describe(faults));
}

int run(const afm::CommandLine& app, Options options) {
  take_si(app, options.dynamics);
  if (options.vary != "gamma") afm::take_si(app, options.dynamics.si, "to", options.to);
  const afm::Model model = checked_model(options.dynamics);
  const double eta = options.dynamics.eta;
  if (!app.is_given("to")) throw std::invalid_argument("to: must be given");
  if (eta == 0.0) throw std::invalid_argument("eta = 0: without drag there is no orbit but rest");
  check_target(app, options);
  options.search.longest = options.length;
  const auto found = search_orbits(afm::PoincareMap(model, eta), options.search);
  afm::TableWriter table(std::cout, columns(options.vary), afm::table_units(options.dynamics.si));
  table.write_header();
  int number = 0;
  for (const afm::FoundOrbit& f : found.orbits) {
    if (f.orbit.length() != static_cast<std::size_t>(options.length)) continue;
    print(++number, continue_orbit(model, eta, f.orbit, varied(options.vary).parameter, options.to), table);
    table.flush();
  }
  if (number == 0) std::cerr << "continue_orbits: no orbit of length " << options.length << " found\n";
  return number > 0 ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  afm::CommandLine app("continue_orbits", kDescription);
  Options options;
  add_options(app, options);
  return app.run(argc, argv, [&] { return run(app, options); });
}
