// Calls that take long: without the GIL, on threads, and stopped by Ctrl-C.
#pragma once

#include <pybind11/pybind11.h>

#include <chrono>
#include <functional>

#include "afm/state.h"

namespace afm::python {

// Runs `work` once on each of so many threads (0: one for each processor) while this thread looks ten times a second
// whether a Python signal handler raises, or `watch`, called with the GIL, throws. Then work is stopped at its next
// interruption_point(), and the exception goes on from here.
void run_on_threads(int threads, const std::function<void()>& work, const std::function<void()>& watch = {});

// The end of one step to `end`: long quiet flights and slides are cut, so that signals are seen. No bit depends on it.
inline ModelTime next_stop(const ModelTime& now, const ModelTime& end) {
  constexpr double kLongest = 1000.0;  // [tau]
  const ModelTime stop = now + kLongest;
  return stop < end ? stop : end;
}

// Calls step() until it returns true, without the GIL; ten times a second a signal may be raised. Between two looks at
// the clock are so many steps.
template <class Step>
void repeat(int at_a_time, const Step& step) {
  constexpr std::chrono::milliseconds kBetweenSignals(100);
  for (bool done = false; !done;) {
    {
      const pybind11::gil_scoped_release released;
      const auto end = std::chrono::steady_clock::now() + kBetweenSignals;
      while (!done && std::chrono::steady_clock::now() < end) {
        for (int i = 0; i < at_a_time && !done; ++i) done = step();
      }
    }
    if (PyErr_CheckSignals() != 0) throw pybind11::error_already_set();
  }
}

}  // namespace afm::python
