// Calls that take long: without the GIL, on threads, and stopped by Ctrl-C.
#pragma once

#include <pybind11/pybind11.h>

#include <functional>

namespace afm::python {

// Runs `work` once on each of so many threads (0: one for each processor) while this thread looks ten times a second whether a
// Python signal handler raises, or `watch`, called with the GIL, throws. Then work is stopped at its next
// interruption_point(), and the exception goes on from here.
void run_on_threads(int threads, const std::function<void()>& work, const std::function<void()>& watch = {});

}  // namespace afm::python
