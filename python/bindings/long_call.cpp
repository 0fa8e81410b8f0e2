#include "long_call.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <exception>
#include <future>
#include <thread>
#include <vector>

#include "afm/interruption.h"

namespace afm::python {
namespace {

namespace py = pybind11;

unsigned thread_count(int asked) {
  return asked > 0 ? static_cast<unsigned>(asked) : std::max(1u, std::thread::hardware_concurrency());
}

void look(const std::function<void()>& watch) {
  const py::gil_scoped_acquire acquired;
  if (PyErr_CheckSignals() != 0) throw py::error_already_set();
  if (watch) watch();
}

}  // namespace

void run_on_threads(int threads, const std::function<void()>& work, const std::function<void()>& watch) {
  constexpr std::chrono::milliseconds kBetweenLooks(100);
  std::atomic<bool> stop{false};
  std::exception_ptr thrown;  // by the first that throws: the others need not go on
  const auto run = [&] {
    const Interruptible interruptible(stop);
    try {
      work();
    } catch (...) {
      if (!stop.exchange(true)) thrown = std::current_exception();
    }
  };
  {
    const py::gil_scoped_release released;
    std::vector<std::future<void>> workers;
    try {
      for (unsigned i = thread_count(threads); i > 0; --i) workers.push_back(std::async(std::launch::async, run));
      for (const std::future<void>& worker : workers) {
        while (worker.wait_for(kBetweenLooks) != std::future_status::ready) look(watch);
      }
    } catch (...) {  // a signal: it goes on from here when the workers have stopped, for which their futures wait
      stop = true;
      throw;
    }
  }
  if (thrown) std::rethrow_exception(thrown);
  if (watch) watch();
}

}  // namespace afm::python
