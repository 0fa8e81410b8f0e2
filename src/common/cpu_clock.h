// Time that this thread has used: on a shared machine the wall clock measures the others.
#pragma once

#include <ctime>

namespace afm {

inline double thread_seconds() {
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

}  // namespace afm
