// How much faster than real time one tip is, over drag speeds, cutoffs, levers, loads and baths, and what K_f comes
// out: CSV. In processor time, but for the slowest tau. times_real_time counts a tau as 157.08 us, the paper's, for
// every lever; lever_times_real_time as long as it is with the one given. A tau that seems the slowest is made again,
// as it may have been interrupted.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <iostream>
#include <limits>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include "afm/number_text.h"
#include "afm/sweep.h"
#include "afm/tip.h"
#include "afm/units.h"
#include "common/command_line.h"
#include "common/cpu_clock.h"
#include "common/lever_options.h"
#include "common/point_options.h"

namespace {

using Clock = std::chrono::steady_clock;

constexpr double kLongest = 1e12;  // [tau] a choice, as of friction_curve

struct Options {
  std::vector<double> eta, cutoff, rest_height, temperature, quality_factor;
  std::vector<double> frequency_ratio{afm::Model{}.frequency_ratio}, amplitude{afm::Model{}.H};
  std::string model = "oscillator";
  afm::Bath bath;  // its kicks, and the lateral quality factor of the lever
  double tolerance = afm::kDefaultContactTolerance;
  std::int64_t tau = 1000, transient = 200;
  afm::LeverOptions lever;
};

struct Point {
  afm::SweepPoint at;
  afm::Bath bath;
};

struct Figures {
  double times_real_time, slowest_tau_us, K_f, impacts_per_tau;
  long search_failures;
};

struct Losses {
  double energy = 0.0, impacts = 0.0;  // [m_tip a^2/tau^2]; bounces
};

// Up to the given time [tau].
Losses run_tip(afm::Tip& tip, std::int64_t end) {
  Losses lost;
  for (;;) {
    const afm::Outcome outcome = tip.advance({end, 0.0});
    if (outcome == afm::Outcome::search_failed) throw std::runtime_error("the search of an impact cannot go on");
    if (outcome == afm::Outcome::time_limit) return lost;
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
  const afm::Model m = model_of(point.at);
  const double eta = point.at.eta;
  const afm::FreeState flank{0.25, 0.0, 0.2, eta, 0.0};
  afm::Tip tip(m, eta, is_held_down(m) ? afm::lowered_tip(m.H) : flank, o.tolerance);
  tip.set_bath(point.bath);
  const afm::Tip start = tip;
  const double begin = afm::thread_seconds();
  run_tip(tip, o.transient);
  const Losses lost = run_tip(tip, o.transient + o.tau);
  const double seconds = (afm::thread_seconds() - begin) / static_cast<double>(o.transient + o.tau);
  const double tau_s = afm::Units(afm::SiModel{}).time(), taus = static_cast<double>(o.tau);
  const double K_f = eta == 0.0 ? std::numeric_limits<double>::quiet_NaN() : lost.energy / (eta * eta * taus);
  return {tau_s / seconds, 1e6 * slowest_tau(start, o), K_f, lost.impacts / taus,
          static_cast<long>(tip.search_failures())};
}

// Every combination of the options; drag speeds vary fastest. Throws std::invalid_argument with the faults of the first
// that cannot be run.
std::vector<Point> points_of(const Options& o) {
  std::vector<Point> points{{{0.0, afm::Model{}.gamma, 0.0, afm::checked_kind(o.model)}, o.bath}};
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
  cross(o.frequency_ratio, [](Point& p, double value) { p.at.frequency_ratio = value; });
  cross(o.amplitude, [](Point& p, double value) { p.at.H = value; });
  cross(o.rest_height, [](Point& p, double value) { p.at.y0 = value; });
  cross(o.temperature, [](Point& p, double value) { p.bath.temperature = value; });
  cross(o.quality_factor, [](Point& p, double value) { p.bath.quality_factor = value; });
  cross(o.cutoff, [](Point& p, double value) { p.at.v_c = value; });
  cross(o.eta, [](Point& p, double value) { p.at.eta = value; });
  for (const Point& point : points) {
    afm::SweepSettings settings;
    settings.bath = point.bath;
    auto faults = afm::find_faults(point.at);
    for (const afm::ParameterError& fault : afm::find_faults(settings)) faults.push_back(fault);
    if (!faults.empty()) throw std::invalid_argument(afm::describe(faults));
  }
  return points;
}

void check(const Options& o) {
  if (!afm::is_contact_tolerance(o.tolerance)) {
    throw afm::ParameterError("tolerance", o.tolerance, "must be 0, or between 1e-9 and 0.01");
  }
}

// At once, so that a run of hours ends with the first line that is lost.
void print_line(const std::string& line) {
  if (!(std::cout << line << std::endl)) throw std::runtime_error("cannot write the output");
}

void give_warnings(const afm::CommandLine& app, const std::vector<Point>& points) {
  std::set<std::string> texts;
  for (const Point& p : points) {
    for (const afm::ParameterError& warning : afm::find_warnings(p.at, p.bath)) {
      if (texts.insert(warning.what()).second) app.warn(warning.what());
    }
  }
}

// Whoever gives a lever and a load in SI may take the temperature for kelvin.
void warn_of_heat(const afm::CommandLine& app, const Options& o, const afm::Units& units) {
  constexpr double kHot = 2000.0, kRoom = 300.0;  // [K] a choice: hotter than any lever
  constexpr int kFew = 3;
  const double hottest = *std::max_element(o.temperature.begin(), o.temperature.end());
  const double kelvin = hottest * units.temperature();
  if (!afm::LeverOptions::are_given(app) || kelvin < kHot) return;
  app.warn("temperature = " + afm::number_text(hottest) + ": is kT in m_tip a^2/tau^2 of this lever and crystal, " +
           afm::number_text(std::round(kelvin)) + " K; for 300 K give " +
           afm::rounded_text(kRoom / units.temperature(), kFew));
}

// As its file, that of the surface and the load say, where no option says otherwise.
afm::SiModel take_lever(const afm::CommandLine& app, Options& o) {
  if (!afm::LeverOptions::are_given(app)) return {};
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
      "real_time",
      "Times real time, slowest tau and K_f of one tip, over drag speeds and cutoffs (natural units). K_f is that of\n"
      "the losses in impacts: with a bath it is no friction. An option with VALUES takes numbers and ranges\n"
      "FROM:TO:STEP, with spaces or commas between.");
  app.ranges("eta", o.eta, "0:9:0.05", "drag speeds [a/tau]");
  app.ranges("cutoff", o.cutoff, "0.1,0.05,0.01,0.001", "v_c [a/tau]");
  app.option("tolerance", o.tolerance, "contact tolerance");
  afm::add_model_option(app, o.model);
  app.ranges("frequency-ratio", o.frequency_ratio, "", "omega_h/omega_v");
  app.ranges("amplitude", o.amplitude, "", "of the surface [a]");
  app.ranges("rest-height", o.rest_height, "0", "of the holder above mid-surface [a]");
  app.ranges("temperature", o.temperature, "0", "kT of the heat bath [m_tip a^2/tau^2]");
  app.ranges("quality-factor", o.quality_factor, "0", "of the cantilever; 0: neither damped nor heated");
  app.option("kicks-per-tau", o.bath.kicks_per_tau, "of the heat bath");
  app.option("tau", o.tau, "measured time each", {1.0, kLongest});
  app.option("transient", o.transient, "time before that", {0.0, kLongest});
  afm::add_lever_options(app, o.lever);
  return app.run(argc, argv, [&] {
    check(o);
    const afm::Units units(take_lever(app, o));
    const double of_lever = units.time() / afm::Units(afm::SiModel{}).time();
    const std::vector<Point> points = points_of(o);
    give_warnings(app, points);
    warn_of_heat(app, o, units);
    print_line(std::string("eta,cutoff,times_real_time,slowest_tau_us,k_f,impacts_per_tau,search_failures,"
                           "frequency_ratio,amplitude,rest_height,temperature,quality_factor") +
               (afm::LeverOptions::are_given(app) ? ",lever_times_real_time" : ""));
    for (const Point& p : points) {
      const Figures f = measure(p, o);
      char row[400];
      const int length =
          std::snprintf(row, sizeof row, "%.17g,%.17g,%.4g,%.4g,%.9g,%.6g,%ld,%.17g,%.17g,%.17g,%.17g,%.17g", p.at.eta,
                        p.at.v_c, f.times_real_time, f.slowest_tau_us, f.K_f, f.impacts_per_tau, f.search_failures,
                        p.at.frequency_ratio, p.at.H, p.at.y0, p.bath.temperature, p.bath.quality_factor);
      if (afm::LeverOptions::are_given(app)) {
        std::snprintf(row + length, sizeof row - static_cast<std::size_t>(length), ",%.4g",
                      f.times_real_time * of_lever);
      }
      print_line(row);
    }
    return 0;
  });
}
