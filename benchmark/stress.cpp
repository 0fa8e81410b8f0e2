// Random models under random commands, every invariant checked after every segment: finite, never below the surface,
// energy in balance, the search never gives up, time goes on. Ends with the first violation and what reproduces it.
#include <chrono>
#include <iostream>

#include "common/command_line.h"
#include "stress_scene.h"

namespace {

struct Options {
  std::uint64_t seed = 1, scenes = 0;
  std::int64_t tau = 1000;
  double seconds = 20.0;
  bool mica = false, shipped = false, levers = false;
};

void add(afm::TipCount& sum, const afm::TipCount& c) {
  sum.segments += c.segments;
  sum.impacts += c.impacts;
  sum.bounces += c.bounces;
  sum.commands += c.commands;
  sum.most_segments_in_a_tau = std::max(sum.most_segments_in_a_tau, c.most_segments_in_a_tau);
  sum.deepest = std::max(sum.deepest, c.deepest);
  sum.worst_imbalance = std::max(sum.worst_imbalance, c.worst_imbalance);
}

void print(std::uint64_t scenes, std::int64_t tau, const afm::TipCount& c) {
  std::cout << scenes << " scenes of " << tau << " tau: " << c.commands << " commands, " << c.segments << " segments, "
            << c.impacts << " impacts standing for " << c.bounces << " bounces; most segments in a tau "
            << c.most_segments_in_a_tau << ", deepest " << c.deepest << " a, worst imbalance " << c.worst_imbalance
            << std::endl;
}

}  // namespace

int main(int argc, char** argv) {
  Options o;
  afm::CommandLine app(
      "stress", "Random commands to random models, until the time is up or something is violated (natural units).");
  app.option("seed", o.seed, "of the first scene; the next has the next");
  app.option("scenes", o.scenes, "how many; 0: as many as the time allows");
  app.option("tau", o.tau, "model time of each scene", {1, 1000000000});
  app.option("seconds", o.seconds, "no new scene after this time");
  app.flag("mica", o.mica, "the paper's model at cutoffs of 0.001 to 0.1, dragged at up to 9 a/tau either way");
  app.flag("shipped", o.shipped,
           "the node's defaults, commands as scripts/soak sends them; no batch may spend its budget of impacts");
  app.flag("levers", o.levers, "levers on crystals under loads of up to 100 nN, with a heat bath and without");
  return app.run(argc, argv, [&] {
    std::cout.precision(2);
    const auto start = std::chrono::steady_clock::now();
    const auto passed = [&] { return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(); };
    using Kind = afm::StressScene::Kind;
    const Kind kind = o.levers ? Kind::lever : o.shipped ? Kind::shipped : o.mica ? Kind::mica : Kind::any;
    afm::TipCount sum;
    std::uint64_t most_events = 0;
    std::uint64_t scenes = 0, violations = 0;
    double progress = 0.0;
    for (; (o.scenes == 0 || scenes < o.scenes) && passed() < o.seconds; ++scenes) {
      afm::StressScene scene(o.seed + scenes, kind);
      const bool kept = scene.run(o.tau);
      add(sum, scene.count());
      most_events = std::max(most_events, scene.most_events());
      if (!kept) {
        ++violations;
        std::cout << "VIOLATED: " << scene.report() << "\n";
        break;
      }
      if (passed() > progress) {
        print(scenes + 1, o.tau, sum);
        progress = passed() + 10.0;
      }
    }
    print(scenes, o.tau, sum);
    std::cout << violations << " violations; most events in a batch of the node " << most_events << "\n";
    return violations == 0 ? 0 : 1;
  });
}
