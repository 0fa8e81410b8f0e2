// Simulates a recorded run again and compares it with the recording, bit for bit.
#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <iostream>
#include <string>
#include <vector>

#include "common/command_line.h"
#include "node/wire/arithmetic_digest.h"
#include "node/wire/version.h"
#include "tools/replay/damage_guard.h"
#include "tools/replay/digest_check.h"
#include "tools/replay/run_check.h"

namespace {

using afm::ModelTime;
using afm::replay::Difference;
using afm::replay::Extent;
using afm::replay::Problem;
using afm::replay::Recording;
using afm::replay::Verdict;

const char kDescription[] =
    "Simulates a recorded run again, from its configuration and applied commands, and compares every sample, impact,\n"
    "friction value and command with the recording, bit for bit. Needs no ROS master. Recordings begun in mid-run\n"
    "(simulated from the checkpoint that they begin with), split ones (give their bags in order) and reindexed ones "
    "are\n"
    "checked too.";
const char kExitCodes[] =
    "Exit codes:\n"
    "  0  identical, nothing is missing, and the recording was closed\n"
    "  1  it differs: recorded as it was published, but this program simulates other bits\n"
    "  2  wrong arguments\n"
    "  3  foreign: no bag, no recording of the emulator, or one of another version of its messages, or of the state "
    "in\n"
    "     the checkpoint that it begins with\n"
    "  4  truncated: no index or damaged (rosbag reindex helps), or identical as far as it goes but never closed\n"
    "     (killed, or its end cut off; --open-end makes this 0)\n"
    "  5  messages are missing\n"
    "  6  messages are not in the order in which they were published\n"
    "  7  altered: the recording contradicts the digests recorded with it, or itself";

struct Options {
  std::vector<std::string> paths;
  std::string node;
  bool digests_only = false, open_end = false;
};

std::string to_text(const ModelTime& time) {
  char text[64];
  std::snprintf(text, sizeof text, "%lld + %.17g tau", static_cast<long long>(time.tau), time.phase);
  return text;
}

// A line on stderr when it is a terminal, a few times a second.
class ProgressLine {
 public:
  void operator()(double part_done, const ModelTime& time) {
    const auto now = std::chrono::steady_clock::now();
    if (!visible_ || now < due_) return;
    due_ = now + std::chrono::milliseconds(200);
    std::fprintf(stderr, "\r%3.0f %%, model time %lld tau ", 100.0 * part_done, static_cast<long long>(time.tau));
  }
  ~ProgressLine() {
    if (visible_) std::fputs("\r\033[K", stderr);
  }

 private:
  const bool visible_ = isatty(STDERR_FILENO) == 1;
  std::chrono::steady_clock::time_point due_;
};

void print_arithmetic(const afm::replay::RunLog& log) {
  const auto& configuration = log.epochs().begin()->second.configuration;
  const std::string ours = afm::node::arithmetic_digest();
  std::cout << "recorded by version " << configuration.version << ", arithmetic " << configuration.arithmetic_digest
            << "; checked by version " << afm::node::kVersion << ", arithmetic " << ours
            << (ours == configuration.arithmetic_digest ? ": the same\n" : ": NOT THE SAME, so bits may differ\n");
}

void print_start(const afm::replay::RunLog& log) {
  const auto* start = log.epochs().begin()->second.start();
  if (start == nullptr) return;
  std::cout << "simulated from the checkpoint at model time " << to_text(afm::node::from_message(start->time))
            << " of epoch " << start->epoch << ", with which the recording begins\n";
}

void print_extent(const Extent& e, double wall_seconds) {
  std::printf(
      "compared: %llu samples, %llu impacts, %llu friction estimates, %llu commands, %llu digests, %llu checkpoints, "
      "%llu epochs, %.6g s of model time\n",
      static_cast<unsigned long long>(e.samples), static_cast<unsigned long long>(e.impacts),
      static_cast<unsigned long long>(e.estimates), static_cast<unsigned long long>(e.commands),
      static_cast<unsigned long long>(e.digests), static_cast<unsigned long long>(e.checkpoints),
      static_cast<unsigned long long>(e.epochs), e.compared_seconds);
  std::printf("simulated %.6g s of model time in %.3g s: %.3g times real time\n", e.model_seconds, wall_seconds,
              e.model_seconds / wall_seconds);
}

void print_difference(const Difference& d) {
  std::cout << "FIRST DIFFERENCE in epoch " << d.epoch << ", batch " << d.batch << ", at model time " << to_text(d.time)
            << "\n  " << d.field.field << ", number " << d.field.index << "\n    recorded   " << d.field.first
            << "\n    simulated  " << d.field.second << "\n";
  if (d.last_command) std::cout << "  last command " << afm::replay::to_text(*d.last_command) << "\n";
}

Verdict judge(const Difference& d) {
  print_difference(d);
  if (!d.altered) {
    std::cout << "DIFFERENT; no digest stands after it to tell whether the recording was altered\n";
  } else if (*d.altered) {
    std::cout << "ALTERED: the recording contradicts the digests that were recorded with it, or itself\n";
  } else {
    std::cout << "DIFFERENT: the recording agrees with its digests, it is as it was published; here the same "
                 "configuration and commands give other bits\n";
  }
  return d.altered.value_or(false) ? Verdict::altered : Verdict::differs;
}

Verdict judge_end(const Recording& recording, const Options& options) {
  if (recording.is_closed()) {
    std::cout << "IDENTICAL" << (recording.is_continued() ? "; the recording goes on in another bag\n" : "\n");
    return Verdict::sound;
  }
  std::cout << "IDENTICAL as far as it goes; the recording was never closed: what came after this is not in it\n";
  return options.open_end ? Verdict::sound : Verdict::truncated;
}

double seconds_since(std::chrono::steady_clock::time_point begin) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

Verdict check_run(const Recording& recording, const Options& options) {
  const auto begin = std::chrono::steady_clock::now();
  ProgressLine progress;
  afm::replay::RunCheck check(recording, std::ref(progress));
  print_arithmetic(check.log());
  print_start(check.log());
  check.run();
  print_extent(check.extent(), seconds_since(begin));
  if (check.gaps().messages > 0) {
    std::cout << "MISSING: " << check.gaps().messages << " messages, the first " << check.gaps().first << "\n";
  }
  if (check.unpublished().messages > 0) {
    std::cout << "MISSING: " << check.unpublished().messages << " messages that the emulator never published, as its "
              << "machine was too busy, the first " << check.unpublished().first << "\n";
  }
  if (check.difference()) return judge(*check.difference());
  const bool whole = check.gaps().messages + check.unpublished().messages == 0;
  return whole ? judge_end(recording, options) : Verdict::missing;
}

Verdict check_digests(const Recording& recording, const Options& options) {
  const auto begin = std::chrono::steady_clock::now();
  ProgressLine progress;
  const auto report = afm::replay::check_digests(recording, std::ref(progress));
  std::printf("compared: %llu digests of %llu epochs\n", static_cast<unsigned long long>(report.extent.digests),
              static_cast<unsigned long long>(report.extent.epochs));
  const double wall = seconds_since(begin);
  std::printf("simulated %.6g s of model time in %.3g s: %.3g times real time\n", report.extent.model_seconds, wall,
              report.extent.model_seconds / wall);
  if (!report.difference) return judge_end(recording, options);
  std::cout << "equal up to model time " << to_text(report.last_equal) << " of epoch " << report.difference->epoch
            << ", not any more at the next digest\n";
  print_difference(*report.difference);
  std::cout << "DIFFERENT; without --digests-only the first sample or impact that differs is found\n";
  return Verdict::differs;
}

Verdict run(const Options& options) {
  Verdict verdict = Verdict::sound;
  for (const Recording& recording : afm::replay::open_recordings(options.paths, options.node)) {
    std::cout << recording.name() << "\n";
    const Verdict one = options.digests_only ? check_digests(recording, options) : check_run(recording, options);
    if (verdict == Verdict::sound) verdict = one;
  }
  return verdict;
}

}  // namespace

int main(int argc, char** argv) {
  afm::CommandLine app("replay_check", kDescription);
  app.footer(kExitCodes);
  Options options;
  app.arguments("bags", options.paths, "recordings; the bags of a split one in order");
  app.require("bags");
  app.option("node", options.node, "the emulator's name such as /afm, where a bag holds several");
  app.flag("digests-only", options.digests_only,
           "compare only the digests of every second: reads little, and finds the second of a difference");
  app.flag("open-end", options.open_end, "accept a recording that was never closed, as far as it goes");
  afm::replay::guard_against_damage();
  return app.run(argc, argv, [&] {
    try {
      return static_cast<int>(run(options));
    } catch (const Problem& problem) {
      std::cout << std::flush;
      std::cerr << "replay_check: " << problem.what() << "\n";
      return static_cast<int>(problem.verdict);
    } catch (const std::exception& error) {
      std::cerr << "replay_check: damaged or cut off: " << error.what() << "\n";
      return static_cast<int>(Verdict::truncated);
    }
  });
}
