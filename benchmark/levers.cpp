// How much faster than real time one tip is for six levers on three crystals, over loads and speeds: without a bath,
// and with one at 300 K and Q = 100. CSV on stdout, a summary on stderr. In processor time, and in the lever's own tau.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "afm/units.h"
#include "common/command_line.h"
#include "timed_tip.h"

namespace {

// Nominal values: vertical spring constant [N/m], resonance [Hz], omega_h/omega_v; and kicks per tau, as in the files
// of the levers.
struct Lever {
  const char* name;
  double spring_constant, resonance, frequency_ratio, kicks;
};
constexpr Lever kLevers[] = {{"paper", 0.653, 6366.2, 6.25, 11.09},   {"ppp_cont", 0.2, 13e3, 21.0, 12.979},
                             {"csc37_b", 0.3, 21e3, 17.0, 10.507},    {"soft", 0.02, 7e3, 30.0, 18.541},
                             {"fm", 2.8, 75e3, 14.0, 8.652},          {"laterally_soft", 0.5, 20e3, 2.0, 11.09}};

struct Crystal {
  const char* name;
  double spacing, amplitude;  // [m]
};
constexpr Crystal kCrystals[] = {{"mica", 0.52e-9, 0.05e-9}, {"nacl", 0.399e-9, 0.05e-9}, {"hopg", 0.246e-9, 0.02e-9}};

struct Options {
  std::vector<double> load{0.0, 0.1, 0.4, 1.0, 10.0, 100.0}, speed{0.01, 0.1, 1.0, 5.0, 20.0};
  std::vector<std::string> lever;
  std::int64_t tau = 300, transient = 100;
  double tolerance = afm::kDefaultContactTolerance;
};

struct Scene {
  double tau_s;  // the lever's own
  afm::Model model;
  afm::Bath bath;  // 300 K, Q = 100
  double eta;
};

Scene scene_of(const Lever& lever, const Crystal& crystal, double load, double speed) {
  afm::SiModel si;
  si.omega_v_rad_per_s = afm::kTwoPi * lever.resonance;
  si.omega_h_rad_per_s = lever.frequency_ratio * si.omega_v_rad_per_s;
  si.tip_mass_kg = lever.spring_constant / (si.omega_v_rad_per_s * si.omega_v_rad_per_s);
  si.lattice_spacing_m = crystal.spacing;
  si.surface_amplitude_m = crystal.amplitude;
  si.rest_height_m = -load / lever.spring_constant;
  afm::SiBath bath;
  bath.temperature_k = 300.0;
  bath.quality_factor = 100.0;
  bath.kicks_per_tau = lever.kicks;
  const afm::Units units(si);
  return {units.time(), units.to_natural(si), units.to_natural(bath), speed / units.velocity()};
}

struct Summary {
  std::vector<double> times;
  double worst_slow_lever = INFINITY;  // of the levers with a tau of 40 us or more

  void add(double times_real_time, double tau_s) {
    times.push_back(times_real_time);
    if (tau_s >= 40e-6) worst_slow_lever = std::min(worst_slow_lever, times_real_time);
  }
  void print(const char* name) {
    std::sort(times.begin(), times.end());
    const auto below = [&](double limit) {
      return std::lower_bound(times.begin(), times.end(), limit) - times.begin();
    };
    std::fprintf(stderr, "%s: %zu points, below 1: %td, below 3: %td, below 10: %td, least %.3g (tau >= 40 us: %.3g), "
                 "median %.3g\n", name, times.size(), below(1.0), below(3.0), below(10.0), times.front(),
                 worst_slow_lever, times[times.size() / 2]);
  }
};

void print_run(const Scene& scene, const afm::Bath& bath, const Options& o, Summary& summary) {
  const afm::TimedRun timed =
      afm::time_tip(afm::tip_at_start(scene.model, scene.eta, bath, o.tolerance), o.transient, o.tau);
  const double taus = static_cast<double>(o.tau), times = scene.tau_s / timed.seconds;
  std::printf(",%.4g,%.6g,%ld", times, timed.run.events / taus, timed.run.search_failures);
  std::fflush(stdout);
  summary.add(times, scene.tau_s);
}

bool is_wanted(const Options& o, const char* name) {
  return o.lever.empty() || std::find(o.lever.begin(), o.lever.end(), name) != o.lever.end();
}

}  // namespace

int main(int argc, char** argv) {
  Options o;
  afm::CommandLine app("levers", "Times real time of one tip for levers, crystals, loads and speeds.");
  app.option("lever", o.lever, "default: all of them");
  app.option("load", o.load, "normal load [nN]");
  app.option("speed", o.speed, "drag speed [um/s]");
  app.option("tolerance", o.tolerance, "contact tolerance");
  app.option("tau", o.tau, "measured time each");
  app.option("transient", o.transient, "time before that");
  return app.run(argc, argv, [&] {
    std::printf(
        "lever,crystal,load_nn,speed_um_per_s,tau_us,frequency_ratio,amplitude,rest_height,eta,cutoff,temperature,"
        "times_real_time,impacts_per_tau,search_failures,"
        "heated_times_real_time,heated_impacts_per_tau,heated_search_failures\n");
    Summary plain, heated;
    for (const Lever& lever : kLevers) {
      if (!is_wanted(o, lever.name)) continue;
      for (const Crystal& crystal : kCrystals) {
        for (const double load : o.load) {
          for (const double speed : o.speed) {
            const Scene s = scene_of(lever, crystal, 1e-9 * load, 1e-6 * speed);
            std::printf("%s,%s,%g,%g,%.5g,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g", lever.name, crystal.name, load, speed,
                        1e6 * s.tau_s, s.model.frequency_ratio, s.model.H, s.model.y0, s.eta, s.model.v_c,
                        s.bath.temperature);
            print_run(s, {}, o, plain);
            print_run(s, s.bath, o, heated);
            std::printf("\n");
          }
        }
      }
    }
    plain.print("without a bath");
    heated.print("at 300 K, Q = 100");
    return 0;
  });
}
