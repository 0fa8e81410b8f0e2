// The section of the attractor along a parameter, followed up or down.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iostream>
#include <string>
#include <vector>

#include "afm/dynamics/attractor.h"
#include "afm/dynamics/sweep.h"
#include "common/point_options.h"
#include "common/progress_bar.h"
#include "common/table_writer.h"

namespace {

const char kDescription[] =
    "A bifurcation diagram: one tip is carried along a parameter, each value from where the one before ended, and\n"
    "after a transient its impacts are printed (units a, tau, tip mass): the value, surface phase, normal speed\n"
    "before the impact, extension, and the kind of attractor.";

using Q = afm::Quantity;

struct Options {
  afm::PointOptions dynamics;
  std::string vary = "eta", range = "2:3:0.01", sweep = "up";
  int impacts = 100;
  double transient = 500.0;
  bool relative_cutoff = false;
};

afm::PointOptions parameters_at(const Options& o, double value) {
  afm::PointOptions at = o.dynamics;
  varied(at, o.vary) = value;
  if (o.relative_cutoff) at.cutoff *= std::abs(at.eta);
  return at;
}

// The range is of a speed but where gamma varies, or a cutoff as a share of eta.
bool varies_speed(const Options& o) { return o.vary == "eta" || (o.vary == "cutoff" && !o.relative_cutoff); }

// With --si a range of speeds is in m/s, also where eta varies.
std::vector<double> checked_values(const afm::CommandLine& app, const Options& o) {
  if (o.sweep != "up" && o.sweep != "down") throw std::invalid_argument("sweep = " + o.sweep + ": must be up or down");
  if (app.is_given(o.vary)) throw std::invalid_argument(o.vary + ": varies over the range, so it has no value");
  std::vector<double> values = afm::range_option("range", o.range);
  if (varies_speed(o)) afm::take_si(app, o.dynamics.si, "range", values);
  for (const double value : values) checked_model(parameters_at(o, value));
  if (o.sweep == "down") std::reverse(values.begin(), values.end());
  return values;
}

void print_impacts(afm::Tip& tip, double value, int impacts, const std::string& kind, afm::TableWriter& to) {
  constexpr double kLongest = 1000.0;  // [tau]
  const afm::ModelTime end = tip.now() + kLongest;
  for (int i = 0; i < impacts;) {
    const afm::Outcome outcome = tip.advance(end);
    if (outcome == afm::Outcome::time_limit || outcome == afm::Outcome::search_failed) return;
    const afm::Impact& impact = tip.last_impact();
    if (impact.kind != afm::ImpactKind::impact) continue;
    ++i;
    to << value << impact.surface_phase << impact.normal_speed << tip.tip_state().X << kind;
    to.end_row();
  }
}

std::vector<afm::Column> columns(const Options& o) {
  return {{o.vary, varies_speed(o) ? Q::velocity : Q::number, o.vary == "eta" ? "drag_velocity" : ""},
          {"phase"},
          {"normal_speed", Q::velocity},
          {"extension", Q::length},
          {"attractor"}};
}

int run(const afm::CommandLine& app, Options& o) {
  take_si(app, o.dynamics, !o.relative_cutoff);
  afm::take_si(app, o.dynamics.si, "transient", o.transient);
  const std::vector<double> values = checked_values(app, o);
  afm::ProgressBar bar(values.size(), 0);
  afm::TableWriter table(std::cout, columns(o), afm::table_units(o.dynamics.si));
  table.write_header();
  const afm::PointOptions first = parameters_at(o, values.front());
  afm::TipState state = afm::random_start({first.eta, first.gamma, first.cutoff, checked_model(first).kind}, 1, 0);
  std::size_t done = 0;
  for (const double value : values) {
    const afm::PointOptions at = parameters_at(o, value);
    const afm::Model model = checked_model(at);
    afm::Tip tip(model, at.eta, state);
    afm::AttractorSettings settings;
    settings.transient = o.transient;
    const afm::Attractor attractor = find_attractor(model, tip, settings);
    print_impacts(tip, value, o.impacts, attractor.name(), table);
    table.flush();
    state = tip.tip_state();
    bar.show(++done);
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  afm::CommandLine app("bifurcations", kDescription);
  Options o;
  add_options(app, o.dynamics);
  add_si_options(app, o.dynamics);
  app.option("vary", o.vary, "eta, gamma or cutoff");
  app.option("range", o.range, "of it, FROM:TO:STEP; with --si drag velocities and cutoffs in m/s");
  app.option("sweep", o.sweep, "up or down");
  app.option("impacts", o.impacts, "printed at each value", {1, 1000000});
  app.option("transient", o.transient, "before them [tau]", {0.0, 1e9});
  app.flag("relative-cutoff", o.relative_cutoff, "the cutoff is given as a share of |eta|");
  return app.run(argc, argv, [&] { return run(app, o); });
}
