// How far a simpler level of the model is from the full one, and what it saves.
#include "afm/dynamics/model_error.h"

#include <cmath>
#include <iostream>
#include <string>
#include <vector>

#include "afm/dynamics/sweep.h"
#include "common/csv.h"
#include "common/progress_bar.h"
#include "common/point_options.h"
#include "tip_times.h"

namespace {

const char kDescription[] =
    "Compares a level of the model (--model, --contact-tolerance) with the oscillator at --reference-tolerance (0: "
    "every\n"
    "bounce), on the same starts (units a, tau, tip mass). --eta, --gamma, --cutoff and --frequency-ratio may be "
    "ranges\n"
    "FROM:TO:STEP and lists A,B. A row for each start: K_f of both with standard errors and kinds of attractor; "
    "k_f_error, relative;\n"
    "deflection_error, the mean distance of equal quantiles of the vertical deflection, beside that of two halves of "
    "one\n"
    "run (deflection_noise) and its rms; tracking_error, the rms difference over one tau from the same height and "
    "vertical\n"
    "velocity; rms and largest stretch of the reference's horizontal spring; and the time of this thread for a tau of "
    "each\n"
    "(median of alternated runs), with the ratio of reference to level: above 1 the level is cheaper.";

const char kHeader[] =
    "eta,gamma,cutoff,frequency_ratio,model,contact_tolerance,reference_tolerance,start,k_f,k_f_std_error,attractor,"
    "reference_k_f,reference_k_f_std_error,reference_attractor,k_f_error,k_f_error_std_error,deflection_error,"
    "deflection_noise,deflection_rms,tracking_error,stretch_rms,stretch_max,ns_per_tau,reference_ns_per_tau,cost_ratio";

struct Options {
  std::string eta = "3.4", gamma = "0.7", cutoff = "0.05", frequency_ratio = "6.25", model = "hammer";
  bool relative_cutoff = false;
  afm::Level level;
  double reference_tolerance = 1e-5;
  int starts = 3;
  std::uint64_t seed = 1;
  afm::ErrorSettings settings;
};

void add_options(afm::CommandLine& app, Options& o) {
  const afm::Within tolerance{0.0, afm::kMaxContactTolerance};
  app.option("eta", o.eta, "drag velocity [a/tau]");
  app.option("gamma", o.gamma, "restitution at and above the cutoff");
  app.option("cutoff", o.cutoff, "cutoff speed of the restitution [a/tau]");
  app.flag("relative-cutoff", o.relative_cutoff, "the cutoff is given as a share of |eta|");
  app.option("frequency-ratio", o.frequency_ratio, "omega_h / omega_v, of the reference");
  afm::add_model_option(app, o.model);
  app.option("contact-tolerance", o.level.contact_tolerance, "of the level; 0: every bounce", tolerance);
  app.option("reference-tolerance", o.reference_tolerance, "of the reference; 0: every bounce", tolerance);
  app.option("starts", o.starts, "at each point", {1, 10000});
  app.option("seed", o.seed, "of the starts");
  app.option("duration", o.settings.duration, "of the measurement [tau]", {10.0, 1e7});
  app.option("transient", o.settings.transient, "before it [tau]", {0.0, 1e7});
  app.option("most-events", o.settings.most_events, "a level that needs more is measured for a shorter time",
             {1000, 1000000000});
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
  for (const afm::PointOptions& at : afm::grid_option(o.eta, o.gamma, o.cutoff, o.frequency_ratio)) {
    points.push_back(checked_point(o, at));
  }
  return points;
}

void compare(const Options& o, const Point& point, int start) {
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
  std::cout << afm::join_numbers({point.eta, model.gamma, model.v_c, point.model.frequency_ratio}) << "," << o.model
            << ","
            << afm::join_numbers({o.level.contact_tolerance, o.reference_tolerance, static_cast<double>(start), K,
                                  level.friction.K_f_std_error})
            << "," << level.attractor.name() << "," << afm::join_numbers({R, reference.friction.K_f_std_error}) << ","
            << reference.attractor.name() << ","
            << afm::join_numbers({ratio - 1.0, share, afm::quantile_distance(level.vertical, reference.vertical),
                                  reference.vertical_noise, reference.vertical_rms, tracking, reference.stretch_rms,
                                  reference.stretch_largest, times[0], times[1], times[1] / times[0]})
            << "\n";
}

int run(Options o) {
  o.level.kind = afm::checked_kind(o.model);
  const std::vector<Point> points = grid(o);
  const auto starts = static_cast<std::size_t>(o.starts);
  afm::ProgressBar bar(points.size() * starts, 0);
  std::cout << kHeader << "\n";
  for (std::size_t i = 0; i < points.size() * starts; ++i) {
    compare(o, points[i / starts], static_cast<int>(i % starts));
    bar.show(i + 1);
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  afm::CommandLine app("model_error", kDescription);
  Options options;
  add_options(app, options);
  return app.run(argc, argv, [&] { return run(options); });
}
