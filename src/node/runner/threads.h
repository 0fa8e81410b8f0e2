// The operating system for a real-time thread: priority, clocks and a semaphore.
#pragma once

#include <semaphore.h>

#include <chrono>
#include <string>

namespace afm::node {

// Raises the calling thread to SCHED_FIFO with locked memory where that is permitted. Returns what came of it:
// "fifo", "fifo, ..." with what is missing, or "normal: " and the reason.
std::string claim_real_time();

// One step below it, where that is permitted: for a thread that must carry off what the real-time thread makes.
void follow_real_time();

// Names the calling thread for top -H and debuggers: 15 letters at most.
void name_thread(const char* name);

// Time on the monotonic clock.
inline std::chrono::nanoseconds monotonic_now() { return std::chrono::steady_clock::now().time_since_epoch(); }
void sleep_until(std::chrono::nanoseconds deadline);

// A counting semaphore: post() neither blocks, locks nor allocates, so the running thread may use it.
class Semaphore {
 public:
  Semaphore() { sem_init(&semaphore_, 0, 0); }
  ~Semaphore() { sem_destroy(&semaphore_); }
  Semaphore(const Semaphore&) = delete;
  Semaphore& operator=(const Semaphore&) = delete;

  void post() { sem_post(&semaphore_); }
  // Until a post or for `timeout` at most; takes all posts that are there, as one check of a queue answers them all.
  void wait_for(std::chrono::milliseconds timeout);

 private:
  sem_t semaphore_;
};

}  // namespace afm::node
