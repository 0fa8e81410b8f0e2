// rosbag's reader trusts the lengths it finds in a file: a damaged one can make it read beyond its memory. Such an end
// is reported in words, with an exit code, rather than as a crash.
#pragma once

#include <unistd.h>

#include <csignal>
#include <cstdlib>

#include "verdict.h"

namespace afm::replay {

extern "C" inline void on_damage(int) {
  constexpr char kText[] = "crashed while reading: the bag is damaged (rosbag reindex may help), or this is a bug\n";
  if (write(STDERR_FILENO, kText, sizeof kText - 1) < 0) _Exit(static_cast<int>(Verdict::truncated));
  _Exit(static_cast<int>(Verdict::truncated));
}

inline void guard_against_damage() {
  for (const int signal : {SIGSEGV, SIGBUS, SIGABRT, SIGFPE}) std::signal(signal, on_damage);
}

}  // namespace afm::replay
