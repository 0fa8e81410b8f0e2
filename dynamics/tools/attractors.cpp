// The attractors at given parameters, or over a grid of them.
#include <cmath>
#include <iostream>
#include <string>
#include <vector>

#include "afm/dynamics/basins.h"
#include "afm/number_text.h"
#include "common/in_order.h"
#include "common/point_options.h"
#include "common/progress_bar.h"
#include "common/table_writer.h"
#include "study_rows.h"

namespace {

const char kDescription[] =
    "Finds what attractors there are (units a, tau, tip mass): tips are started at random above the surface, and\n"
    "each is followed until what it ends on is known. A row for each attractor: its kind, impacts and cells in a\n"
    "period (0: it does not repeat), K_f with its standard error, Lyapunov exponents [1/tau], rotation number,\n"
    "share of the time in contact, share of the starts that it draws with its standard error, and a start that\n"
    "leads to it (surface phase, extension, height, lab velocity). VALUES are numbers or ranges FROM:TO:STEP;\n"
    "--cutoff is absolute, or a share of eta with --relative-cutoff.";

struct Options {
  afm::PointOptions at;  // but for its drag velocity and restitution
  std::vector<double> eta, gamma, drag_velocity;
  bool relative_cutoff = false;
  unsigned threads = 0;
  afm::BasinSettings basins;
};

void add_options(afm::CommandLine& app, Options& o) {
  app.ranges("eta", o.eta, "3.4", "drag velocity [a/tau]");
  app.ranges("gamma", o.gamma, "0.7", "restitution at and above the cutoff");
  app.option("cutoff", o.at.cutoff, "cutoff speed of the restitution [a/tau]");
  app.flag("relative-cutoff", o.relative_cutoff, "the cutoff is given as a share of |eta|");
  app.option("starts", o.basins.starts, "tips started at each point", {1, 1000000});
  app.option("seed", o.basins.seed, "of the starts");
  app.option("transient", o.basins.attractor.transient, "before anything is looked at [tau]", {0.0, 1e9});
  app.option("duration", o.basins.attractor.duration, "of the search for a period and of the exponents [tau]",
             afm::kPositive);
  app.option("friction-duration", o.basins.friction_duration, "of the measurement of K_f [tau]", afm::kPositive);
  afm::add_tip_options(app, o.at);
  app.option("threads", o.threads, "0: one for each processor", {0, 1024});
  app.ranges("drag-velocity", o.drag_velocity, "", afm::kDragVelocityHelp);
  afm::add_tip_si_options(app, o.at);
}

void check_duration(const char* name, double tau) {
  if (tau >= 1.0 && tau <= 1e9) return;
  throw std::invalid_argument(std::string("--") + name + " = " + afm::number_text(tau) +
                              " tau: must be between 1 and 1e9");
}

// A cutoff that is a share of eta has no unit.
void take_si(const afm::CommandLine& app, Options& o) {
  const auto lever = afm::take_tip_si(app, o.at);
  const afm::SiOptions& si = o.at.si;
  if (o.relative_cutoff && !(o.at.cutoff >= 0.0)) {
    throw std::invalid_argument("cutoff = " + afm::number_text(o.at.cutoff) + ": a share of eta must not be negative");
  }
  if (lever && !o.relative_cutoff) lever->take(app, "cutoff", o.at.cutoff);
  if (!o.relative_cutoff) afm::take_si(app, si, "cutoff", o.at.cutoff);
  if (afm::has_drag_velocity(app, si)) o.eta = o.drag_velocity;
  afm::take_si(app, si, "drag-velocity", o.eta);
  afm::take_si(app, si, "transient", o.basins.attractor.transient);
  afm::take_si(app, si, "duration", o.basins.attractor.duration);
  afm::take_si(app, si, "friction-duration", o.basins.friction_duration);
  check_duration("duration", o.basins.attractor.duration);
  check_duration("friction-duration", o.basins.friction_duration);
}

std::vector<afm::SweepPoint> grid(const afm::CommandLine& app, const Options& options) {
  const double count = static_cast<double>(options.eta.size()) * static_cast<double>(options.gamma.size());
  for (const auto& fault : afm::find_point_count_fault(count)) throw std::invalid_argument(fault.what());
  std::vector<afm::SweepPoint> points;
  for (const double gamma : options.gamma) {
    for (const double eta : options.eta) {
      afm::PointOptions at = options.at;
      at.eta = eta;
      at.gamma = gamma;
      if (options.relative_cutoff) at.cutoff *= std::abs(eta);
      points.push_back(checked_point(app, at));
    }
  }
  return points;
}

int run(const afm::CommandLine& app, Options& options) {
  take_si(app, options);
  const std::vector<afm::SweepPoint> points = grid(app, options);
  for (const afm::SweepPoint& point : points) {
    const double transient = options.basins.attractor.transient;
    const auto warnings = afm::find_short_drag("transient", transient, point.eta, 1.0);
    for (const auto& warning : afm::as_given(app, options.at.si, warnings)) app.warn(warning.what());
  }
  afm::TableWriter table(std::cout, afm::kBasinColumns, afm::table_units(options.at.si));
  table.write_header();
  afm::ProgressBar bar(points.size(), 0);
  const auto compute = [&](std::size_t i) { return find_basins(points[i], options.basins); };
  afm::in_order(
      points.size(), options.threads, compute,
      [&](std::size_t i, const std::vector<afm::Basin>& basins) {
        for (const afm::Basin& basin : basins) write_row(points[i], basin, table);
        table.flush();
        bar.show(i + 1);
      },
      [] {});
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  afm::CommandLine app("attractors", kDescription);
  Options options;
  add_options(app, options);
  return app.run(argc, argv, [&] { return run(app, options); });
}
