#include "threads.h"

#include <pthread.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>

#include <cerrno>
#include <cstring>
#include <ctime>

namespace afm::node {
namespace {

// above every normal thread, below the kernel's own threads (50) that serve timers and disks
constexpr int kPriority = 40;

int processors() {
  cpu_set_t set;
  CPU_ZERO(&set);
  return sched_getaffinity(0, sizeof set, &set) == 0 ? CPU_COUNT(&set) : 1;
}

// With a limit on locked memory, MCL_FUTURE would let later allocations of the whole process fail: all or nothing.
bool lock_memory() {
  const rlimit unlimited{RLIM_INFINITY, RLIM_INFINITY};
  rlimit limit{};
  getrlimit(RLIMIT_MEMLOCK, &limit);
  if (limit.rlim_cur != RLIM_INFINITY && setrlimit(RLIMIT_MEMLOCK, &unlimited) != 0) return false;
  // on fault: what is reserved and never touched (stacks, the impact budget) stays out of memory
  return mlockall(MCL_CURRENT | MCL_FUTURE | MCL_ONFAULT) == 0;
}

// Returns why not, or nothing.
std::string become_fifo(int priority) {
  if (processors() < 2) return "normal: on one processor a real-time thread would starve the rest";
  sched_param parameter{};
  parameter.sched_priority = priority;
  const int error = pthread_setschedparam(pthread_self(), SCHED_FIFO, &parameter);
  return error == 0 ? "" : std::string("normal: SCHED_FIFO: ") + std::strerror(error);
}

timespec to_timespec(std::chrono::nanoseconds time) {
  timespec spec{};
  spec.tv_sec = time.count() / 1000000000;
  spec.tv_nsec = time.count() % 1000000000;
  return spec;
}

}  // namespace

std::string claim_real_time() {
  prctl(PR_SET_TIMERSLACK, 1);  // the normal scheduler may otherwise wake us 50 us late
  const std::string refused = become_fifo(kPriority);
  if (!refused.empty()) return refused;
  return lock_memory() ? "fifo" : "fifo, memory not locked: RLIMIT_MEMLOCK";
}

void follow_real_time() { become_fifo(kPriority - 1); }

void name_thread(const char* name) { pthread_setname_np(pthread_self(), name); }

void sleep_until(std::chrono::nanoseconds deadline) {
  const timespec end = to_timespec(deadline);
  while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &end, nullptr) == EINTR) {
  }
}

// Never by the wall clock: set back by an hour, it would hold a wait up for an hour.
void Semaphore::wait_for(std::chrono::milliseconds timeout) {
  const timespec end = to_timespec(monotonic_now() + timeout);
  while (sem_clockwait(&semaphore_, CLOCK_MONOTONIC, &end) != 0 && errno == EINTR) {
  }
  while (sem_trywait(&semaphore_) == 0) {
  }
}

}  // namespace afm::node
