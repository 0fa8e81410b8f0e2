// How much faster than real time one tip is, over drag speeds, cutoffs, levers, loads and baths, and what K_f comes
// out: CSV. In processor time. times_real_time counts a tau as 157.08 us, the paper's, for every lever;
// lever_times_real_time as long as it is with the one given. A tau that seems the slowest is made again, as it may have
// been interrupted.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <vector>

#include "afm/tip.h"
#include "afm/units.h"
#include "common/command_line.h"
#include "common/cpu_clock.h"
#include "common/lever_options.h"

namespace {

using Clock = std::chrono::steady_clock;

struct Options {
  std::vector<double> eta, cutoff{0.1, 0.05, 0.01, 0.001};
  std::vector<double> frequency_ratio{afm::Model{}.frequency_ratio}, amplitude{afm::Model{}.H}, rest_height{0.0};
  std::vector<double> temperature{0.0}, quality_factor{0.0};
  afm::Bath bath;  // its kicks, and the lateral quality factor of the lever
  double step = 0.05, tolerance = afm::kDefaultContactTolerance;
  std::int64_t tau = 1000, transient = 200;
  afm::LeverOptions lever;
};

struct Point {
  afm::Model model;
  afm::Bath bath;
  double eta;
};

struct Figures {
  double times_real_time, slowest_tau_us, K_f, impacts_per_tau;
  long search_failures;
};

struct Losses {
  double energy = 0.0, impacts = 0.0;  // [m a^2/tau^2]; bounces
};

// Up to the given time [tau].
Losses run_tip(afm::Tip& tip, std::int64_t end) {
  Losses lost;
  for (;;) {
    const afm::Outcome outcome = tip.advance({end, 0.0});
    if (outcome == afm::Outcome::time_limit || outcome == afm::Outcome::search_failed) return lost;
    if (outcome != afm::Outcome::impact) continue;
    lost.energy += tip.last_impact().energy_loss;
    lost.impacts += tip.last_impact().count;
  }
}

double seconds_since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

// The time of the same tau again, the least of some: what is left when the machine does nothing else in between.
double least_seconds(const afm::Tip& before, std::int64_t end) {
  constexpr int kAgain = 5;
  double least = INFINITY;
  for (int i = 0; i < kAgain; ++i) {
    afm::Tip tip = before;
    const auto start = Clock::now();
    run_tip(tip, end);
    least = std::min(least, seconds_since(start));
  }
  return least;
}

double slowest_tau(afm::Tip tip, const Options& o) {
  double slowest = 0.0;
  for (std::int64_t t = 1; t <= o.transient + o.tau; ++t) {
    const afm::Tip before = tip;
    const auto start = Clock::now();
    run_tip(tip, t);
    if (seconds_since(start) > slowest) slowest = std::max(slowest, least_seconds(before, t));
  }
  return slowest;
}

// Twice the same run: as a whole, and tau by tau, for which the clock is read and the tip copied in between. The tip
// falls on the flank of the surface, or was lowered into a valley if the load holds it down there.
Figures measure(const Point& point, const Options& o) {
  const afm::Model& m = point.model;
  const afm::FreeState flank{0.25, 0.0, 0.2, point.eta, 0.0};
  afm::Tip tip(m, point.eta, is_held_down(m) ? afm::lowered_tip(m.H) : flank, o.tolerance);
  tip.set_bath(point.bath);
  const afm::Tip start = tip;
  const double begin = afm::thread_seconds();
  run_tip(tip, o.transient);
  const Losses lost = run_tip(tip, o.transient + o.tau);
  const double seconds = (afm::thread_seconds() - begin) / static_cast<double>(o.transient + o.tau);
  const double tau_s = afm::Units(afm::SiModel{}).time(), taus = static_cast<double>(o.tau);
  return {tau_s / seconds, 1e6 * slowest_tau(start, o), lost.energy / (point.eta * point.eta * taus),
          lost.impacts / taus, static_cast<long>(tip.search_failures())};
}

// Every combination of the options; drag speeds vary fastest.
std::vector<Point> points_of(const Options& o) {
  std::vector<Point> points{{{}, o.bath, 0.0}};
  const auto cross = [&](const std::vector<double>& values, const auto& set) {
    std::vector<Point> all;
    for (const Point& point : points) {
      for (const double value : values) {
        all.push_back(point);
        set(all.back(), value);
      }
    }
    points = all;
  };
  cross(o.frequency_ratio, [](Point& p, double value) { p.model.frequency_ratio = value; });
  cross(o.amplitude, [](Point& p, double value) { p.model.H = value; });
  cross(o.rest_height, [](Point& p, double value) { p.model.y0 = value; });
  cross(o.temperature, [](Point& p, double value) { p.bath.temperature = value; });
  cross(o.quality_factor, [](Point& p, double value) { p.bath.quality_factor = value; });
  cross(o.cutoff, [](Point& p, double value) { p.model.v_c = value; });
  cross(o.eta, [](Point& p, double value) { p.eta = value; });
  for (const Point& point : points) {
    const auto faults = afm::find_faults(point.model);
    const auto bath_faults = afm::find_faults(point.bath);
    if (!faults.empty()) throw faults.front();
    if (!bath_faults.empty()) throw bath_faults.front();
  }
  return points;
}

// As its file, that of the surface and the load say, where no option says otherwise.
afm::SiModel take_lever(const afm::CommandLine& app, Options& o) {
  if (!o.lever.are_given()) return {};
  const afm::LeverScene scene(app, o.lever);
  scene.take(app, "frequency-ratio", o.frequency_ratio);
  scene.take(app, "amplitude", o.amplitude);
  scene.take(app, "rest-height", o.rest_height);
  scene.take(app, "cutoff", o.cutoff);
  scene.take(app, "quality-factor", o.quality_factor);
  scene.take(app, "lateral-quality-factor", o.bath.lateral_quality_factor);
  scene.take(app, "kicks-per-tau", o.bath.kicks_per_tau);
  return scene.si;
}

}  // namespace

int main(int argc, char** argv) {
  Options o;
  afm::CommandLine app(
      "real_time", "Times real time, slowest tau and K_f of one tip, over drag speeds and cutoffs (natural units).");
  app.option("eta", o.eta, "drag speeds [a/tau]; default: 0 to 9 in steps of --step");
  app.option("step", o.step, "");
  app.option("cutoff", o.cutoff, "v_c [a/tau]");
  app.option("tolerance", o.tolerance, "contact tolerance");
  app.option("frequency-ratio", o.frequency_ratio, "omega_h/omega_v");
  app.option("amplitude", o.amplitude, "of the surface [a]");
  app.option("rest-height", o.rest_height, "of the holder above mid-surface [a]");
  app.option("temperature", o.temperature, "kT of the heat bath [m a^2/tau^2]");
  app.option("quality-factor", o.quality_factor, "of the cantilever; 0: no bath");
  app.option("kicks-per-tau", o.bath.kicks_per_tau, "of the heat bath");
  app.option("tau", o.tau, "measured time each");
  app.option("transient", o.transient, "time before that");
  afm::add_lever_options(app, o.lever);
  return app.run(argc, argv, [&] {
    if (o.eta.empty()) {
      for (int i = 0; i * o.step <= 9.0 + 1e-9; ++i) o.eta.push_back(i * o.step);
    }
    const double of_lever = afm::Units(take_lever(app, o)).time() / afm::Units(afm::SiModel{}).time();
    std::printf(
        "eta,cutoff,times_real_time,slowest_tau_us,k_f,impacts_per_tau,search_failures,frequency_ratio,amplitude,"
        "rest_height,temperature,quality_factor%s\n",
        o.lever.are_given() ? ",lever_times_real_time" : "");
    for (const Point& p : points_of(o)) {
      const Figures f = measure(p, o);
      std::printf("%.17g,%.17g,%.4g,%.4g,%.9g,%.6g,%ld,%.17g,%.17g,%.17g,%.17g,%.17g", p.eta, p.model.v_c,
                  f.times_real_time, f.slowest_tau_us, f.K_f, f.impacts_per_tau, f.search_failures,
                  p.model.frequency_ratio, p.model.H, p.model.y0, p.bath.temperature, p.bath.quality_factor);
      if (o.lever.are_given()) std::printf(",%.4g", f.times_real_time * of_lever);
      std::printf("\n");
      std::fflush(stdout);
    }
    return 0;
  });
}
