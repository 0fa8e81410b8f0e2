// Is a recording sound? What can be said without simulating the run again, on one page.
#include <cstdio>
#include <iostream>
#include <string>
#include <vector>

#include "tools/audit/bag_audit.h"
#include "common/command_line.h"
#include "tools/replay/damage_guard.h"
#include "tools/replay/recording.h"

namespace {

using afm::audit::Finding;
using afm::replay::Problem;
using afm::replay::Recording;
using afm::replay::Verdict;

const char kDescription[] =
    "Checks a recording by itself, without simulating the run again: nothing missing; samples and impacts in order "
    "and\n"
    "at their times; the digests recorded with it; energy lost against the law of restitution, and, where samples "
    "stand\n"
    "close enough, against the motion before and after each impact; the published friction summed again from the\n"
    "impacts; the counters that must stay zero. replay_check compares with the simulated run, bit for bit.";
const char kExitCodes[] =
    "Exit codes: 0 sound; 1 not; 2 wrong arguments; 3 foreign, 4 truncated, 5 missing, 6 reordered, 7 altered where\n"
    "that keeps it from being read at all (as replay_check).";

void print(const Finding& finding) {
  const char* marks[] = {"ok ", "BAD", "   "};
  std::printf("  %s %-15s %s\n", marks[static_cast<int>(finding.kind)], finding.subject.c_str(), finding.text.c_str());
}

void print(const afm::audit::Stretch& s) {
  std::printf("      eta %9.5g for %10.6g tau: K_f published %.6g +- %.2g, from the impacts %.6g m_tip/tau\n", s.eta,
              s.tau, s.published, s.error, s.recomputed);
}

bool is_sound(const Recording& recording) {
  std::printf("%s\n", recording.name().c_str());
  afm::audit::BagAudit audit(recording);
  bool sound = true;
  for (const Finding& finding : audit.run()) {
    print(finding);
    sound = sound && finding.kind != Finding::Kind::bad;
  }
  for (const auto& stretch : audit.friction().stretches) print(stretch);
  std::printf("%s\n", sound ? "SOUND" : "NOT SOUND");
  return sound;
}

}  // namespace

int main(int argc, char** argv) {
  afm::CommandLine app("bag_check", kDescription);
  app.footer(kExitCodes);
  std::vector<std::string> paths;
  std::string node;
  app.arguments("bags", paths, "recordings; the bags of a split one in order");
  app.require("bags");
  app.option("node", node, "the emulator's name such as /afm, where a bag holds several");
  afm::replay::guard_against_damage();
  return app.run(argc, argv, [&] {
    try {
      bool sound = true;
      for (const Recording& recording : afm::replay::open_recordings(paths, node)) sound = is_sound(recording) && sound;
      return sound ? 0 : 1;
    } catch (const Problem& problem) {
      std::fflush(stdout);
      std::cerr << "bag_check: " << problem.what() << "\n";
      return static_cast<int>(problem.verdict);
    } catch (const std::exception& error) {
      std::cerr << "bag_check: damaged or cut off: " << error.what() << "\n";
      return static_cast<int>(Verdict::truncated);
    }
  });
}
