// Which level of the model `model: auto` takes, without running anything.
#include <cstdio>
#include <fstream>
#include <iostream>
#include <string>

#include "afm/level_table.h"
#include "common/csv.h"
#include "common/point_options.h"

namespace {

const char kDescription[] =
    "Tells which level of the model `model: auto` takes at a drag velocity and a tolerance, with the error that is "
    "expected of it\n"
    "(nan: the table knows nothing there), from a table such as config/levels.csv (units a, tau, tip mass). Needs no "
    "ROS.";

struct Options {
  std::string table, eta = "3.4", of = "friction";
  double gamma = 0.7, cutoff = 0.0501446519707602, frequency_ratio = 6.25, tolerance = 0.01;
  double contact_tolerance = afm::kDefaultContactTolerance;
};

afm::LevelTable read_table(const std::string& path) {
  std::ifstream file(path);
  if (!file) throw std::invalid_argument("table = " + path + ": cannot be read");
  try {
    return afm::LevelTable(file);
  } catch (const std::exception& error) {
    throw std::invalid_argument("table = " + path + ": " + error.what());
  }
}

int run(const Options& o) {
  const afm::LevelTable table = read_table(o.table);
  afm::PointOptions at;
  at.gamma = o.gamma;
  at.cutoff = o.cutoff;
  at.frequency_ratio = o.frequency_ratio;
  const afm::Model model = afm::checked_model(at);
  afm::ToleranceOf of = afm::ToleranceOf::friction;
  if (!parse(o.of, of)) throw std::invalid_argument("of = " + o.of + ": must be friction or deflection");
  std::cout << "eta,gamma,cutoff,frequency_ratio,tolerance,tolerance_of,model,contact_tolerance,expected_error\n";
  for (const double eta : afm::range_option("eta", o.eta)) {
    const auto choice = table.choose(model, eta, o.tolerance, of, {afm::ModelKind::oscillator, o.contact_tolerance});
    std::cout << afm::join_numbers({eta, o.gamma, o.cutoff, o.frequency_ratio, o.tolerance}) << "," << o.of << ","
              << name(choice.level.kind) << ","
              << afm::join_numbers({choice.level.contact_tolerance, choice.expected_error}) << "\n";
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  afm::CommandLine app("choose_level", kDescription);
  Options o;
  app.option("table", o.table, "file");
  app.require("table");
  app.option("eta", o.eta, "drag velocity [a/tau], or a range FROM:TO:STEP");
  app.option("gamma", o.gamma, "restitution at and above the cutoff");
  app.option("cutoff", o.cutoff, "cutoff speed of the restitution [a/tau]");
  app.option("frequency-ratio", o.frequency_ratio, "omega_h / omega_v");
  app.option("tolerance", o.tolerance, "error allowed, relative", afm::kPositive);
  app.option("of", o.of, "of what: friction or deflection");
  app.option("contact-tolerance", o.contact_tolerance, "where the table knows nothing",
             {0.0, afm::kMaxContactTolerance});
  return app.run(argc, argv, [&] { return run(o); });
}
