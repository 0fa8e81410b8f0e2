// Long computations that can be stopped from another thread: orbits, attractors, exponents and averages look for a stop
// at each event. It costs nothing to those who do not ask for it.
#pragma once

#include <atomic>
#include <exception>

namespace afm {

struct Interrupted : std::exception {
  const char* what() const noexcept override { return "interrupted"; }
};

// While it lives, interruption_point() on this thread throws Interrupted once `stop` is true.
class Interruptible {
 public:
  explicit Interruptible(const std::atomic<bool>& stop) : before_(stop_of_thread()) { stop_of_thread() = &stop; }
  ~Interruptible() { stop_of_thread() = before_; }
  Interruptible(const Interruptible&) = delete;
  Interruptible& operator=(const Interruptible&) = delete;

  static const std::atomic<bool>*& stop_of_thread() {
    thread_local const std::atomic<bool>* stop = nullptr;
    return stop;
  }

 private:
  const std::atomic<bool>* before_;
};

inline void interruption_point() {
  const std::atomic<bool>* stop = Interruptible::stop_of_thread();
  if (stop != nullptr && stop->load(std::memory_order_relaxed)) throw Interrupted();
}

}  // namespace afm
