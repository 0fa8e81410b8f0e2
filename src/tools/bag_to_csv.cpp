// A topic of a recording as CSV, for any other program.
#include <iostream>
#include <stdexcept>
#include <string>
#include <vector>

#include "common/command_line.h"
#include "tools/export/bag_table.h"
#include "tools/replay/damage_guard.h"

namespace {

using afm::replay::Problem;
using afm::replay::Recording;
using afm::replay::Verdict;

const char kDescription[] =
    "Writes one topic of a recording as CSV to the standard output, in SI, 17 digits. The names of the columns tell\n"
    "their units. Topics:\n"
    "  impacts     epoch, model time (whole tau and a phase, exact; time: both together, rounded), running index,\n"
    "              surface phase, normal speed, tangential velocity, energy loss, kind (0 impact, 1 burst, 2 contact\n"
    "              begun, 3 contact ended) and the count of bounces that it stands for\n"
    "  deflection  epoch, running index, time, vertical, lateral: a row for each sample\n"
    "  friction    the fields of afm_emulator/Friction, a row for each batch\n"
    "  commands    a row for every moment at which commands took effect, and for the beginning of every epoch: all "
    "that\n"
    "              is in force from there on (nan: the recording does not tell)\n"
    "A missing message shows as a gap in the running index; bag_check counts them.";
const char kExitCodes[] =
    "Exit codes: 0 written; 1 the output cannot be written; 2 wrong arguments; 3 foreign, 4 truncated, 5 missing,\n"
    "6 reordered, 7 altered (as replay_check).";

// The bags must be the parts of one recording, as rows of two would mix.
void write(const std::vector<std::string>& paths, const std::string& node, const std::string& topic, bool natural) {
  const auto recordings = afm::replay::open_recordings(paths, node);
  if (recordings.size() > 1) {
    throw Problem(Verdict::usage, recordings.back().name() + ": does not go on where " + recordings.front().name() +
                                      " ends: give the bags of one recording, in order");
  }
  afm::write_bag_table(recordings.front(), topic, natural, std::cout);
}

}  // namespace

int main(int argc, char** argv) {
  std::ios::sync_with_stdio(false);
  afm::CommandLine app("bag_to_csv", kDescription);
  app.footer(kExitCodes);
  std::vector<std::string> paths;
  std::string topic, node;
  bool natural = false;
  app.arguments("bags", paths, "a recording; the bags of a split one in order");
  app.require("bags");
  app.option("topic", topic, "impacts, deflection, friction or commands");
  app.require("topic");
  app.flag("natural", natural, "in lattice spacings a, periods tau and tip masses m_tip instead of SI");
  app.option("node", node, "the emulator's name such as /afm, where a bag holds several");
  afm::replay::guard_against_damage();
  return app.run(argc, argv, [&] {
    if (!afm::is_bag_table(topic)) {
      throw std::invalid_argument("topic = " + topic + ": must be impacts, deflection, friction or commands");
    }
    try {
      write(paths, node, topic, natural);
      return 0;
    } catch (const Problem& problem) {
      std::cout.flush();
      std::cerr << "bag_to_csv: " << problem.what() << "\n";
      return static_cast<int>(problem.verdict);
    } catch (const std::exception& error) {
      std::cout.flush();
      std::cerr << "bag_to_csv: damaged or cut off: " << error.what() << "\n";
      return static_cast<int>(Verdict::truncated);
    }
  });
}
