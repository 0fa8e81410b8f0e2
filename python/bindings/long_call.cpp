#include "long_call.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

#include "afm/interruption.h"

namespace afm::python {
namespace {

namespace py = pybind11;

class Workers {
 public:
  Workers(int threads, const std::function<void()>& work) : working_(threads) {
    for (int i = 0; i < threads; ++i) threads_.emplace_back([this, &work] { run(work); });
  }
  ~Workers() {
    stop();
    for (std::thread& thread : threads_) thread.join();
  }
  Workers(const Workers&) = delete;
  Workers& operator=(const Workers&) = delete;

  void stop() { stop_ = true; }
  bool wait(std::chrono::milliseconds patience) {
    std::unique_lock<std::mutex> lock(mutex_);
    return ended_.wait_for(lock, patience, [this] { return working_ == 0; });
  }
  void rethrow() {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (thrown_) std::rethrow_exception(thrown_);
  }

 private:
  void run(const std::function<void()>& work) {
    const Interruptible interruptible(stop_);
    std::exception_ptr thrown;
    try {
      work();
    } catch (...) {
      thrown = std::current_exception();
      stop();  // the others need not go on
    }
    const std::lock_guard<std::mutex> lock(mutex_);
    if (thrown && !thrown_) thrown_ = thrown;
    --working_;
    ended_.notify_all();
  }

  std::atomic<bool> stop_{false};
  std::mutex mutex_;
  std::condition_variable ended_;
  int working_;
  std::exception_ptr thrown_;
  std::vector<std::thread> threads_;
};

int thread_count(int asked) {
  return asked > 0 ? asked : std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

void look(const std::function<void()>& watch) {
  const py::gil_scoped_acquire acquired;
  if (PyErr_CheckSignals() != 0) throw py::error_already_set();
  if (watch) watch();
}

}  // namespace

// A signal leaves by an exception: the workers' destructor stops and joins them, still without the GIL.
void run_on_threads(int threads, const std::function<void()>& work, const std::function<void()>& watch) {
  constexpr std::chrono::milliseconds kBetweenLooks(100);
  {
    const py::gil_scoped_release released;
    Workers workers(thread_count(threads), work);
    while (!workers.wait(kBetweenLooks)) look(watch);
    workers.rethrow();
  }
  if (watch) watch();
}

}  // namespace afm::python
