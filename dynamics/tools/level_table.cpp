// Makes the table from which `model: auto` takes its levels.
#include <cstdio>
#include <iostream>
#include <string>
#include <vector>

#include "afm/number_text.h"
#include "common/in_order.h"
#include "common/point_options.h"
#include "common/progress_bar.h"
#include "level_errors.h"

namespace {

const char kDescription[] =
    "Measures how far each level of the model (hammer; oscillator with chatter sequences at several contact\n"
    "tolerances; oscillator with every bounce) is from the finest, over the drag velocity (units a, tau, tip mass),\n"
    "and writes the table from which `model: auto` takes its levels. Without options it is the one that is shipped\n"
    "as config/levels.csv, but for the costs, which are measured, and for coarse levels that these leave out.";

// The shipped cutoff is 0.166 um/s, in these units.
struct Options {
  std::vector<double> eta;
  double gamma = 0.7, cutoff = 0.0501446519707602, frequency_ratio = 6.25;
  unsigned threads = 0;
  afm::LevelErrorSettings settings;
};

void add_options(afm::CommandLine& app, Options& o) {
  app.ranges("eta", o.eta, "0.1:9:0.1", "drag velocities [a/tau] above 0: numbers or ranges FROM:TO:STEP");
  app.option("gamma", o.gamma, "restitution at and above the cutoff");
  app.option("cutoff", o.cutoff, "cutoff speed of the restitution [a/tau]");
  app.option("frequency-ratio", o.frequency_ratio, "omega_h / omega_v");
  app.option("starts", o.settings.starts, "at each point", {1, 1000});
  app.option("seed", o.settings.seed, "of the starts");
  app.option("duration", o.settings.run.duration, "of a measurement, where the orbit does not repeat itself [tau]",
             {100.0, 1e7});
  app.option("threads", o.threads, "0: as many as the machine has", {0, 1024});
}

void check_drag_velocities(const Options& o) {
  for (const double eta : o.eta) {
    if (!(eta > 0.0)) throw std::invalid_argument("eta = " + afm::number_text(eta) + ": must be above 0");
  }
}

std::string to_row(double eta, const afm::MeasuredLevel& m) {
  char text[160];
  std::snprintf(text, sizeof text, ",%s,%g,%.3g,%.3g,%.3g\n", name(m.level.kind), m.level.contact_tolerance,
                m.error.friction, m.error.deflection, m.error.cost);
  return afm::number_text(eta) + text;
}

int run(const Options& o) {
  afm::PointOptions at;
  at.gamma = o.gamma;
  at.cutoff = o.cutoff;
  at.frequency_ratio = o.frequency_ratio;
  const afm::Model model = afm::checked_model(at);
  check_drag_velocities(o);
  afm::ProgressBar bar(o.eta.size(), 0);
  std::cout << afm::LevelTable::head(model);
  const auto measure = [&](std::size_t i) {
    std::string rows;
    for (const auto& level : measure_levels(model, o.eta[i], o.settings)) rows += to_row(o.eta[i], level);
    return rows;
  };
  afm::in_order(
      o.eta.size(), o.threads, measure,
      [&](std::size_t i, const std::string& rows) {
        std::cout << rows << std::flush;
        bar.show(i + 1);
      },
      [] {});
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  afm::CommandLine app("level_table", kDescription);
  Options options;
  add_options(app, options);
  return app.run(argc, argv, [&] { return run(options); });
}
