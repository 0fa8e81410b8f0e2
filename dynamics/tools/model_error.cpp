// How far a simpler level of the model is from the full one, and what it saves; or all levels of a scene.
#include "afm/dynamics/model_error.h"

#include <yaml-cpp/yaml.h>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include "afm/number_text.h"
#include "afm/sweep.h"
#include "afm/units.h"
#include "common/lever_options.h"
#include "common/point_options.h"
#include "common/progress_bar.h"
#include "common/table_writer.h"
#include "level_errors.h"

namespace {

const char kDescription[] =
    "Compares a level of the model (--model, --contact-tolerance) with the oscillator at --reference-tolerance\n"
    "(0: every bounce), on the same starts (units a, tau, tip mass). VALUES are numbers or ranges FROM:TO:STEP,\n"
    "with spaces or commas between. A row for each start: K_f of both with standard\n"
    "errors and kinds of attractor; k_f_error, relative; deflection_error, the mean distance of equal quantiles\n"
    "of the vertical deflection, beside that of two halves of one run (deflection_noise) and its rms;\n"
    "tracking_error, the rms difference over one tau from the same height and vertical velocity; rms and largest\n"
    "extension of the reference's horizontal spring; and the time of this thread for a tau of each (median of\n"
    "alternated runs), with the ratio of reference to level: above 1 the level is cheaper. With --scene, and no\n"
    "other option but --duration: the levels at the parameters of these scenes (config/scenes, or files), at\n"
    "their drag velocities, against the finest that keeps time there: errors of K_f and of the deflection, both\n"
    "relative, cost over that of the default level, and whether it is the one that the scene uses.";

const char kHeader[] =
    "eta,gamma,cutoff,frequency_ratio,model,contact_tolerance,reference_tolerance,start,k_f,k_f_std_error,attractor,"
    "reference_k_f,reference_k_f_std_error,reference_attractor,k_f_error,k_f_error_std_error,deflection_error,"
    "deflection_noise,deflection_rms,tracking_error,extension_rms,extension_max,ns_per_tau,reference_ns_per_tau,"
    "cost_ratio";

const char kSceneHeader[] = "scene,eta,model,contact_tolerance,k_f_error,deflection_error,cost,in_use";

struct Options {
  std::vector<std::string> scenes;
  std::vector<double> eta, gamma, cutoff, frequency_ratio;
  std::string model = "hammer";
  bool relative_cutoff = false;
  afm::Level level;
  double reference_tolerance = 1e-5;
  int starts = 3;
  std::uint64_t seed = 1;
  afm::ErrorSettings settings;
};

void add_options(afm::CommandLine& app, Options& o) {
  const afm::Within tolerance{0.0, afm::kMaxContactTolerance};
  app.option("scene", o.scenes, "names, or files that end in .yaml");
  app.ranges("eta", o.eta, "3.4", "drag velocity [a/tau]");
  app.ranges("gamma", o.gamma, "0.7", "restitution at and above the cutoff");
  app.ranges("cutoff", o.cutoff, "0.05", "cutoff speed of the restitution [a/tau]");
  app.flag("relative-cutoff", o.relative_cutoff, "the cutoff is given as a share of |eta|");
  app.ranges("frequency-ratio", o.frequency_ratio, "6.25", "omega_h / omega_v, of the reference");
  afm::add_model_option(app, o.model);
  app.option("contact-tolerance", o.level.contact_tolerance, "of the level; 0: every bounce", tolerance);
  app.option("reference-tolerance", o.reference_tolerance, "of the reference; 0: every bounce", tolerance);
  app.option("starts", o.starts, "at each point", {1, 10000});
  app.option("seed", o.seed, "of the starts");
  app.option("duration", o.settings.duration, "of the measurement [tau]", {10.0, 1e7});
  app.option("transient", o.settings.transient, "before it [tau]", {0.0, 1e7});
}

struct Point {
  afm::Model model;  // of the reference
  double eta;
};

Point checked_point(const Options& o, afm::PointOptions at) {
  if (o.relative_cutoff) at.cutoff *= std::abs(at.eta);
  const Point point{afm::checked_model(at), at.eta};
  if (at.eta == 0.0) throw std::invalid_argument("eta = 0: without drag there is no friction to compare");
  return point;
}

std::vector<Point> grid(const Options& o) {
  std::vector<Point> points;
  for (const double cutoff : o.cutoff) {
    for (const double gamma : o.gamma) {
      for (const double ratio : o.frequency_ratio) {
        for (const double eta : o.eta) {
          afm::PointOptions at;
          at.eta = eta, at.gamma = gamma, at.cutoff = cutoff, at.frequency_ratio = ratio;
          points.push_back(checked_point(o, at));
        }
      }
    }
  }
  return points;
}

void compare(const Options& o, const Point& point, int start, afm::TableWriter& to) {
  const afm::Model model = at_level(point.model, o.level);
  const afm::SweepPoint drawn{point.eta, model.gamma, model.v_c};
  const afm::TipState begin = random_start(drawn, o.seed, static_cast<std::uint64_t>(start));
  afm::Tip tip(model, point.eta, begin, o.level.contact_tolerance);
  afm::Tip full(point.model, point.eta, begin, o.reference_tolerance);
  const afm::LevelRun level = run_level(model, tip, o.settings), reference = run_level(point.model, full, o.settings);
  const std::vector<double> times = afm::nanoseconds_per_tau({tip, full});
  const double tracking = tracking_error(point.model, o.level, full, o.settings);
  const double K = level.friction.K_f, R = reference.friction.K_f, ratio = K / R;
  const double share = std::hypot(level.friction.K_f_std_error / R, ratio * reference.friction.K_f_std_error / R);
  to << point.eta << model.gamma << model.v_c << point.model.frequency_ratio << o.model << o.level.contact_tolerance
     << o.reference_tolerance << start << K << level.friction.K_f_std_error << level.attractor.name() << R
     << reference.friction.K_f_std_error << reference.attractor.name() << ratio - 1.0 << share
     << afm::quantile_distance(level.vertical, reference.vertical) << reference.vertical_noise << reference.vertical_rms
     << tracking << reference.stretch_rms << reference.stretch_largest << times[0] << times[1] << times[1] / times[0];
  to.end_row();
  to.flush();
}

// Parameters of the emulator by their names: those of a scene, and where it is silent those of config/emulator.yaml.
YAML::Node parameters_of(const std::string& scene) {
  const std::string folder = afm::config_folder().string();
  const bool is_name = std::filesystem::path(scene).extension() != ".yaml";
  YAML::Node all = YAML::LoadFile(folder + "/emulator.yaml");
  for (const auto& entry : YAML::LoadFile(is_name ? folder + "/scenes/" + scene + ".yaml" : scene)) {
    all[entry.first.as<std::string>()] = entry.second;
  }
  return all;
}

double number(const YAML::Node& p, const char* name) {
  const double value = p[name].as<double>(std::nan(""));
  if (!std::isfinite(value))
    throw std::invalid_argument(std::string(name) + " = '" + p[name].Scalar() + "' is not a number");
  return value;
}

afm::SiModel si_model(const YAML::Node& p) {
  afm::SiModel si;
  si.omega_v_rad_per_s = number(p, "omega_v_rad_per_s");
  si.omega_h_rad_per_s = number(p, "omega_h_rad_per_s");
  si.tip_mass_kg = number(p, "tip_mass_kg");
  si.lattice_spacing_m = number(p, "lattice_spacing_m");
  si.surface_amplitude_m = number(p, "surface_amplitude_m");
  si.restitution_gamma = number(p, "restitution_gamma");
  si.cutoff_speed = number(p, "cutoff_speed");
  si.rest_height_m = number(p, "rest_height_m");
  const afm::Lever lever{number(p, "spring_constant_n_per_m"), number(p, "resonance_hz"),
                         number(p, "lateral_spring_constant_n_per_m")};
  for (const afm::ParameterError& fault : set_lever_and_load(lever, number(p, "load_n"), si)) throw fault;
  for (const afm::ParameterError& fault : find_faults(si)) throw fault;
  return si;
}

// Some of the drag velocities that a scene sends; else its own.
std::vector<double> drag_velocities(const YAML::Node& p, const afm::Units& units) {
  constexpr std::size_t kMost = 5;
  std::set<double> sent;
  for (const double eta : p["commands_eta"].as<std::vector<double>>()) {
    if (!std::isfinite(eta))
      throw std::invalid_argument("commands_eta = " + afm::number_text(eta) + ": must be finite");
    sent.insert(std::abs(eta));
  }
  if (sent.empty()) sent.insert(std::abs(number(p, "drag_velocity")) / units.velocity());
  sent.erase(0.0);
  const std::vector<double> all(sent.begin(), sent.end());
  std::vector<double> etas;
  for (std::size_t i = 0; i < all.size(); i += (all.size() + kMost - 1) / kMost) etas.push_back(all[i]);
  return etas;
}

struct Scene {
  explicit Scene(const std::string& name_or_file) : name(name_or_file) {
    try {
      read(parameters_of(name));
    } catch (const std::exception& fault) {
      throw std::invalid_argument("scene = " + name + ": " + fault.what());
    }
  }

  void read(const YAML::Node& p) {
    if (number(p, "quality_factor") > 0.0 || number(p, "lateral_quality_factor") > 0.0)
      throw std::invalid_argument("it has a bath, and levels are compared without one");
    const afm::SiModel si = si_model(p);
    const afm::Units units(si);
    model = units.to_natural(si);
    in_use.contact_tolerance = number(p, "contact_tolerance");
    is_stated = afm::parse(p["model"].as<std::string>(), in_use.kind);
    etas = drag_velocities(p, units);
  }

  std::string name;
  afm::Model model;
  afm::Level in_use;
  bool is_stated;  // false: auto
  std::vector<double> etas;
};

void compare_levels(const Scene& scene, double eta, const afm::LevelErrorSettings& settings) {
  for (const afm::MeasuredLevel& m : measure_levels(scene.model, eta, settings)) {
    char text[160];
    std::snprintf(text, sizeof text, ",%.6g,%s,%g,%.3g,%.3g,%.3g,%d\n", eta, name(m.level.kind),
                  m.level.contact_tolerance, m.error.friction, m.error.deflection, m.error.cost,
                  scene.is_stated && m.level == scene.in_use);
    std::cout << scene.name << text << std::flush;
  }
}

int run_scenes(const afm::CommandLine& app, const Options& o) {
  for (const char* other : {"eta", "gamma", "cutoff", "relative-cutoff", "frequency-ratio", "model",
                            "contact-tolerance", "reference-tolerance", "starts", "seed", "transient"}) {
    if (app.is_given(other)) throw std::invalid_argument(std::string(other) + ": not with --scene, which says all");
  }
  const std::vector<Scene> scenes(o.scenes.begin(), o.scenes.end());
  afm::LevelErrorSettings settings;
  if (app.is_given("duration")) settings.run.duration = o.settings.duration;
  std::size_t points = 0, done = 0;
  for (const Scene& scene : scenes) points += scene.etas.size();
  afm::ProgressBar bar(points, 0);
  std::cout << kSceneHeader << "\n";
  for (const Scene& scene : scenes) {
    for (const double eta : scene.etas) {
      compare_levels(scene, eta, settings);
      bar.show(++done);
    }
  }
  return 0;
}

int run(Options o) {
  o.level.kind = afm::checked_kind(o.model);
  const std::vector<Point> points = grid(o);
  const auto starts = static_cast<std::size_t>(o.starts);
  afm::ProgressBar bar(points.size() * starts, 0);
  afm::TableWriter table(std::cout, kHeader);
  table.write_header();
  for (std::size_t i = 0; i < points.size() * starts; ++i) {
    compare(o, points[i / starts], static_cast<int>(i % starts), table);
    bar.show(i + 1);
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  afm::CommandLine app("model_error", kDescription);
  Options options;
  add_options(app, options);
  return app.run(argc, argv, [&] { return options.scenes.empty() ? run(options) : run_scenes(app, options); });
}
