// Every method on the same flights: time per impact against true error, impacts missed and impacts that are none. CSV.
#include "speed_accuracy.h"

#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <memory>
#include <stdexcept>

#include "afm/tip.h"
#include "common/command_line.h"

namespace {

using afm::Contender;
using afm::SpeedRow;
using afm::rivals::is_chosen;

const char kDescription[] =
    "Runs every method on the same flights and writes a CSV table: time per impact (median of alternated rounds,\n"
    "and its ratio to ours in the same rounds), error of impact time and state against quad precision (the\n"
    "largest of all, units a and tau), impacts missed and phantom. Scenes: etaE_vcS (flights on the attractor at\n"
    "drag velocity E, cutoff S eta), all (these together), kf_2, kf_3, kf_3.4 (the error is that of K_f over a\n"
    "run; missed and phantom count impacts against the reference's rate). `setting` is the tolerance or the step\n"
    "of the method.";

struct Options {
  bool quick = false;
  std::vector<std::string> methods, scenes;
  std::size_t flights = 400;
  int rounds = 5;
  double seconds = 2.0, tau = 1000.0, run_seconds = 60.0;
  std::string pace;
};

using File = std::unique_ptr<std::FILE, int (*)(std::FILE*)>;

struct FlightSceneName {
  std::string name;
  double eta, share;
};

std::vector<FlightSceneName> flight_scenes() {
  std::vector<FlightSceneName> names;
  for (const double share : {0.1, 0.01}) {
    for (const double eta : {0.5, 1.5, 2.0, 2.5, 3.4, 4.5, 6.0, 8.0}) {
      char name[40];
      std::snprintf(name, sizeof name, "eta%g_vc%g", eta, share);
      names.push_back({name, eta, share});
    }
  }
  return names;
}

const std::vector<std::string> kFrictionScenes{"kf_2", "kf_3", "kf_3.4"};

std::vector<Contender> contenders(const Options& o, bool tips) {
  std::vector<Contender> all;
  for (const afm::rivals::MethodSpec& spec : afm::rivals::methods()) {
    if (!is_chosen(o.methods, spec.name)) continue;
    std::vector<double> settings = o.quick ? std::vector<double>{spec.usual} : spec.settings;
    if (tips && spec.name == "exact") settings = {0.0, 1e-6, 1e-5, 1e-4, 1e-3, 1e-2};
    for (const double setting : settings) all.push_back({&spec, setting});
  }
  return all;
}

void shorten(Options& o) {
  o.flights = std::min<std::size_t>(o.flights, 60);
  o.rounds = 2;
  o.seconds = 0.3;
  o.tau = 20.0;
  o.run_seconds = 0.5;
  if (o.scenes.empty()) o.scenes = {"eta0.5_vc0.1", "eta2_vc0.1", "eta3.4_vc0.1", "all", "kf_2"};
  std::fprintf(
      stderr,
      "speed_accuracy: --quick: one setting a method, %zu flights a scene, 2 rounds, runs of %g tau. Left out: "
      "all scenes but eta0.5_vc0.1, eta2_vc0.1, eta3.4_vc0.1 and kf_2, unless --scenes names them\n",
      o.flights, o.tau);
}

// Names that are none are an error, not an empty table.
void check_names(const Options& o) {
  std::vector<std::string> scenes = kFrictionScenes, methods;
  scenes.push_back("all");
  for (const auto& scene : flight_scenes()) scenes.push_back(scene.name);
  for (const auto& spec : afm::rivals::methods()) methods.push_back(spec.name);
  afm::rivals::check_names("methods", o.methods, methods);
  afm::rivals::check_names("scenes", o.scenes, scenes);
}

afm::FrictionScene friction_scene(const std::string& name, const Options& o) {
  if (name == "kf_2") return afm::even_scene(2.0);
  if (name == "kf_3") return afm::long_run_scene(name, 3.0, 0.01, o.tau, false);
  return afm::long_run_scene(name, 3.4, 0.1, o.tau, true);
}

void run(const Options& o, std::FILE* pace) {
  const bool terminal = isatty(STDERR_FILENO) != 0;
  const afm::Progress progress = [&](const std::string& scene, const Contender& c) {
    if (terminal) std::fprintf(stderr, "\r\033[K%s: %s %g", scene.c_str(), c.spec->name.c_str(), c.setting);
  };
  const auto done = [&](const std::string& scene) {
    std::fprintf(stderr, terminal ? "\r\033[K" : "%s done\n", scene.c_str());
  };
  afm::print_header(stdout);
  if (pace != nullptr) afm::print_pace_header(pace);
  std::vector<std::vector<SpeedRow>> scenes;
  for (const FlightSceneName& name : flight_scenes()) {
    if (!is_chosen(o.scenes, name.name)) continue;
    afm::Model model;
    model.v_c = name.share * name.eta;
    const afm::FlightScene scene = afm::sample_attractor(name.name, model, name.eta, o.flights, 1);
    scenes.push_back(afm::measure_flights(scene, contenders(o, false), o.rounds, o.seconds, progress));
    for (const SpeedRow& row : scenes.back()) afm::print(row, stdout);
    done(name.name);
  }
  if (is_chosen(o.scenes, "all") && !scenes.empty()) {
    for (const SpeedRow& row : afm::pool(scenes, "all")) afm::print(row, stdout);
  }
  for (const std::string& name : kFrictionScenes) {
    if (!is_chosen(o.scenes, name)) continue;
    const afm::FrictionScene scene = friction_scene(name, o);
    for (const SpeedRow& row : afm::measure_friction(scene, contenders(o, true), o.tau, o.run_seconds, progress)) {
      afm::print(row, stdout);
      if (pace != nullptr) afm::print_pace(scene, row, pace);
    }
    done(name);
  }
}

bool is_written(std::FILE* file) { return std::ferror(file) == 0 && std::fflush(file) == 0; }

}  // namespace

int main(int argc, char** argv) {
  Options o;
  afm::CommandLine app("speed_accuracy", kDescription);
  app.flag("quick", o.quick, "within 40 s; says what it leaves out");
  app.option("methods", o.methods, "only these");
  app.option("scenes", o.scenes, "only these");
  app.option("flights", o.flights, "flights a scene", afm::kPositive);
  app.option("rounds", o.rounds, "times each is measured", afm::kPositive);
  app.option("seconds", o.seconds, "no further round for a method that has used so much on a scene");
  app.option("tau", o.tau, "length of the runs for K_f", afm::kPositive);
  app.option("run-seconds", o.run_seconds, "a run for K_f ends there, wherever it is");
  app.option("pace", o.pace,
             "file for a second table: processor time per second of model time against the error of K_f");
  return app.run(argc, argv, [&] {
    check_names(o);
    if (o.quick) shorten(o);
    const File pace(o.pace.empty() ? nullptr : std::fopen(o.pace.c_str(), "w"), std::fclose);
    if (!o.pace.empty() && pace == nullptr) throw std::runtime_error("cannot write " + o.pace);
    run(o, pace.get());
    if (!is_written(stdout) || (pace != nullptr && !is_written(pace.get()))) {
      throw std::runtime_error("cannot write the output");
    }
    return 0;
  });
}
