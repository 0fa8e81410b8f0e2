// Makes the table from which `model: auto` takes its levels.
#include <atomic>
#include <cmath>
#include <cstdio>
#include <iostream>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "afm/number_text.h"
#include "common/csv.h"
#include "common/point_options.h"
#include "common/progress_bar.h"
#include "level_errors.h"

namespace {

const char kDescription[] =
    "Measures how far each level of the model (hammer; oscillator with bursts at several contact tolerances; "
    "oscillator with\n"
    "every bounce) is from the finest, over the drag velocity (units a, tau, tip mass), and writes the table from "
    "which\n"
    "`model: auto` takes its levels. Without options it is the one that is shipped as config/levels.csv, but for the "
    "costs, which\n"
    "are measured, and for coarse levels that these leave out.";

// The shipped cutoff is 0.166 um/s, in these units.
struct Options {
  std::string eta = "0.1:9:0.1";
  double gamma = 0.7, cutoff = 0.0501446519707602, frequency_ratio = 6.25;
  unsigned threads = 0;
  afm::LevelErrorSettings settings;
};

void add_options(afm::CommandLine& app, Options& o) {
  app.option("eta", o.eta, "drag velocities [a/tau] above 0: a range FROM:TO:STEP, or a list A,B");
  app.option("gamma", o.gamma, "restitution at and above the cutoff");
  app.option("cutoff", o.cutoff, "cutoff speed of the restitution [a/tau]");
  app.option("frequency-ratio", o.frequency_ratio, "omega_h / omega_v");
  app.option("starts", o.settings.starts, "at each point", {1, 1000});
  app.option("seed", o.settings.seed, "of the starts");
  app.option("duration", o.settings.run.duration, "of a measurement, where the orbit does not repeat itself [tau]",
             {100.0, 1e7});
  app.option("threads", o.threads, "0: as many as the machine has", {0, 1024});
}

std::vector<double> drag_velocities(const Options& o) {
  const std::vector<double> etas = afm::ranges_option("eta", o.eta);
  for (const double eta : etas) {
    if (!(eta > 0.0)) throw std::invalid_argument("eta = " + afm::number_text(eta) + ": must be above 0");
  }
  return etas;
}

std::string to_row(double eta, const afm::MeasuredLevel& m) {
  char text[160];
  std::snprintf(text, sizeof text, ",%s,%g,%.3g,%.3g,%.3g\n", name(m.level.kind), m.level.contact_tolerance,
                m.error.friction, m.error.deflection, m.error.cost);
  return afm::number_text(eta) + text;
}

// A point is a function of its parameters alone, so the threads show nowhere but in the cost.
std::vector<std::string> measure(const afm::Model& model, const std::vector<double>& etas, const Options& o) {
  std::vector<std::string> rows(etas.size());
  std::atomic<std::size_t> next{0}, done{0};
  std::mutex showing;
  afm::ProgressBar bar(etas.size(), 0);
  const auto work = [&] {
    for (std::size_t i = next++; i < etas.size(); i = next++) {
      for (const auto& level : measure_levels(model, etas[i], o.settings)) rows[i] += to_row(etas[i], level);
      const std::lock_guard<std::mutex> lock(showing);
      bar.show(++done);
    }
  };
  std::vector<std::thread> threads;
  const unsigned count = o.threads > 0 ? o.threads : std::max(1u, std::thread::hardware_concurrency());
  for (unsigned i = 1; i < count; ++i) threads.emplace_back(work);
  work();
  for (std::thread& thread : threads) thread.join();
  return rows;
}

int run(const Options& o) {
  afm::PointOptions at;
  at.gamma = o.gamma;
  at.cutoff = o.cutoff;
  at.frequency_ratio = o.frequency_ratio;
  const afm::Model model = afm::checked_model(at);
  const std::vector<double> etas = drag_velocities(o);
  const std::vector<std::string> rows = measure(model, etas, o);
  std::cout << afm::LevelTable::head(model);
  for (const std::string& row : rows) std::cout << row;
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  afm::CommandLine app("level_table", kDescription);
  Options options;
  add_options(app, options);
  return app.run(argc, argv, [&] { return run(options); });
}
