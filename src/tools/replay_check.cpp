// Simulates a recorded run again and compares it with the recording, byte for byte.
#include <chrono>
#include <cstdio>
#include <iostream>
#include <optional>
#include <string>
#include <vector>

#include "common/command_line.h"
#include "common/progress_bar.h"
#include "tools/bags/run_check.h"

namespace {

using afm::bags::Difference;
using afm::bags::Extent;
using afm::bags::Recording;
using afm::bags::RunCheck;

const char kDescription[] =
    "Simulates a recorded run again, from its snapshots and what was applied, and compares every message with the\n"
    "recording, bit for bit. Needs no ROS master. The bags of a split recording are given together, or each by itself.\n"
    "Exit codes: 0 identical; 1 different; 2 wrong arguments; 3 it cannot be checked, or not as a whole.";

constexpr int kIdentical = 0, kDifferent = 1, kCannotBeChecked = 3;

void print(const Extent& e, double wall_seconds) {
  std::cout << "compared: " << e.batches << " batches (" << e.deflections << " of deflection with " << e.samples
            << " samples, " << e.impact_arrays << " with " << e.impacts << " impacts), " << e.commands
            << " commands and " << e.snapshots << " snapshots of " << e.epochs << " epochs\n";
  std::printf("simulated: %.6g s of model time in %.3g s\n", e.model_seconds, wall_seconds);
}

void print(const Difference& d) {
  std::cout << "DIFFERENT: the first difference is in message " << d.seq << " of " << d.topic << ", at " << d.time
            << "\n  " << d.field.field << "\n    recorded   " << d.field.recorded << "\n    simulated  "
            << d.field.simulated << "\n  last command: " << d.last_command << "\n";
}

std::string topics_not_held(const Recording& recording) {
  std::string names;
  if (!recording.holds<afm_emulator::Deflection>()) names = "deflection";
  if (!recording.holds<afm_emulator::ImpactArray>()) names += names.empty() ? "impacts" : " nor impacts";
  return names;
}

int check(const Recording& recording) {
  std::cout << recording.name() << std::endl;
  const auto begin = std::chrono::steady_clock::now();
  std::optional<afm::ProgressBar> bar;
  RunCheck check(recording, [&](std::size_t done, std::size_t all) {
    if (!bar) bar.emplace(all, 0, "batches");
    bar->show(done);
  });
  check.run();
  bar.reset();
  const Extent& extent = check.extent();
  print(extent, std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
  for (const std::string& what : check.missing()) std::cout << "missing: " << what << "\n";
  if (check.difference()) {
    print(*check.difference());
    return kDifferent;
  }
  const auto print_unknown = [](std::uint64_t count, const char* what) {
    if (count > 0) std::cout << "not compared: " << count << what << "\n";
    return count > 0;
  };
  bool is_whole = check.missing().empty();
  is_whole &= !print_unknown(extent.batches_unknown, " batches, as the state before them is not known");
  is_whole &= !print_unknown(extent.commands_unknown, " commands, as the state before them is not known");
  is_whole &= !print_unknown(extent.batches_without_friction, " batches without a message of friction");
  if (extent.batches == 0) {
    std::cout << "CANNOT BE CHECKED: there is no batch whose beginning is known\n";
    return kCannotBeChecked;
  }
  if (!is_whole) {
    std::cout << "CANNOT BE CHECKED as a whole; what was compared is identical\n";
    return kCannotBeChecked;
  }
  const std::string absent = topics_not_held(recording);
  std::cout << "IDENTICAL" << (absent.empty() ? "" : " in what it holds; it holds no " + absent) << "\n";
  return kIdentical;
}

// A difference counts more than what cannot be checked.
int check_all(const std::vector<std::string>& paths, const std::string& node) {
  int result = kIdentical;
  for (const Recording& recording : afm::bags::open_recordings(paths, node)) {
    int one = kCannotBeChecked;
    try {
      one = check(recording);
    } catch (const std::exception& error) {
      std::cout << "CANNOT BE CHECKED: " << error.what() << "\n";
    }
    if (result != kDifferent && one != kIdentical) result = one;
  }
  return result;
}

}  // namespace

int main(int argc, char** argv) {
  afm::CommandLine app("replay_check", kDescription);
  std::vector<std::string> paths;
  std::string node;
  app.arguments("bags", paths, "recordings; of a split one all bags");
  app.option("node", node, "the emulator's name such as /afm; else all that the bags hold");
  const auto work = [&] {
    if (paths.empty()) throw std::invalid_argument("bags: must be given");
    try {
      return check_all(paths, node);
    } catch (const std::exception& error) {
      std::cout << "CANNOT BE CHECKED: " << error.what() << "\n";
      return kCannotBeChecked;
    }
  };
  return app.run(argc, argv, work, kCannotBeChecked);
}
