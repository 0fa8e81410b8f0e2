// How much faster than real time one tip is for six levers on three crystals, over loads and speeds: without a bath,
// and with one at 300 K and Q = 100. CSV. In processor time, and in the lever's own tau.
#include <cstdio>

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

constexpr double kLoads[] = {0.0, 0.1, 0.4, 1.0, 10.0, 100.0};   // [nN]
constexpr double kSpeeds[] = {0.01, 0.1, 1.0, 5.0, 20.0};        // [um/s]

struct Options {
  std::int64_t tau = 300, transient = 100;
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

void print_run(const Scene& scene, const afm::Bath& bath, const Options& o) {
  const afm::TimedRun timed = afm::time_tip(afm::tip_at_start(scene.model, scene.eta, bath), o.transient, o.tau);
  std::printf(",%.4g,%.6g,%ld", scene.tau_s / timed.seconds, timed.run.events / static_cast<double>(o.tau),
              timed.run.search_failures);
  std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
  Options o;
  afm::CommandLine app("levers", "Times real time of one tip for levers, crystals, loads and speeds.");
  app.option("tau", o.tau, "measured time each");
  app.option("transient", o.transient, "time before that");
  return app.run(argc, argv, [&] {
    std::printf(
        "lever,crystal,load_nn,speed_um_per_s,tau_us,frequency_ratio,amplitude,rest_height,eta,cutoff,temperature,"
        "times_real_time,impacts_per_tau,search_failures,"
        "heated_times_real_time,heated_impacts_per_tau,heated_search_failures\n");
    for (const Lever& lever : kLevers) {
      for (const Crystal& crystal : kCrystals) {
        for (const double load : kLoads) {
          for (const double speed : kSpeeds) {
            const Scene s = scene_of(lever, crystal, 1e-9 * load, 1e-6 * speed);
            std::printf("%s,%s,%g,%g,%.5g,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g", lever.name, crystal.name, load, speed,
                        1e6 * s.tau_s, s.model.frequency_ratio, s.model.H, s.model.y0, s.eta, s.model.v_c,
                        s.bath.temperature);
            print_run(s, {}, o);
            print_run(s, s.bath, o);
            std::printf("\n");
          }
        }
      }
    }
    return 0;
  });
}
