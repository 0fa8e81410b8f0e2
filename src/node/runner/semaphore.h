// A counting semaphore: post() neither blocks, locks nor allocates, so the stepping thread and signal handlers may use
// it.
#pragma once

#include <semaphore.h>

#include <cerrno>
#include <chrono>
#include <ctime>

namespace afm::node {

class Semaphore {
 public:
  Semaphore() { sem_init(&semaphore_, 0, 0); }
  ~Semaphore() { sem_destroy(&semaphore_); }
  Semaphore(const Semaphore&) = delete;
  Semaphore& operator=(const Semaphore&) = delete;

  void post() { sem_post(&semaphore_); }

  // Until a post or for `timeout` at most; takes all posts that are there, as one check of a queue answers them all.
  void wait_for(std::chrono::milliseconds timeout) {
    const timespec end = after(timeout);
    while (sem_clockwait(&semaphore_, CLOCK_MONOTONIC, &end) != 0 && errno == EINTR) {
    }
    while (sem_trywait(&semaphore_) == 0) {
    }
  }

 private:
  // never by the wall clock: set back by an hour, it would hold a wait up for an hour
  static timespec after(std::chrono::milliseconds timeout) {
    timespec end{};
    clock_gettime(CLOCK_MONOTONIC, &end);
    const std::int64_t nanoseconds = end.tv_nsec + std::chrono::nanoseconds(timeout).count();
    end.tv_sec += nanoseconds / 1000000000;
    end.tv_nsec = nanoseconds % 1000000000;
    return end;
  }

  sem_t semaphore_;
};

}  // namespace afm::node
