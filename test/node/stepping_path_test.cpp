// What steps a tip in real time neither allocates, nor locks, nor calls the system: every allocation and every lock of
// the thread is counted, and where nothing may be called the kernel has orders to kill whoever calls it.
#include <dlfcn.h>
#include <gtest/gtest.h>
#include <pthread.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <linux/seccomp.h>

#include <cstdlib>
#include <vector>

#include "afm/emulator.h"
#include "node/stepping/hand_over.h"

namespace {
thread_local long t_allocations = 0, t_locks = 0;

template <class Function>
Function real(const char* name) {
  return reinterpret_cast<Function>(dlsym(RTLD_NEXT, name));
}
}  // namespace

// These stand before the C library's for the whole program, and for its libraries: operator new comes through here too.
extern "C" {
void* __libc_malloc(std::size_t);
void* __libc_calloc(std::size_t, std::size_t);
void* __libc_realloc(void*, std::size_t);
void __libc_free(void*);
void* malloc(std::size_t size) { return ++t_allocations, __libc_malloc(size); }
void* calloc(std::size_t count, std::size_t size) { return ++t_allocations, __libc_calloc(count, size); }
void* realloc(void* old, std::size_t size) { return ++t_allocations, __libc_realloc(old, size); }
void free(void* memory) { ++t_allocations, __libc_free(memory); }
int pthread_mutex_lock(pthread_mutex_t* mutex) {
  static const auto lock = real<int (*)(pthread_mutex_t*)>("pthread_mutex_lock");
  return ++t_locks, lock(mutex);
}
int pthread_mutex_trylock(pthread_mutex_t* mutex) {
  static const auto lock = real<int (*)(pthread_mutex_t*)>("pthread_mutex_trylock");
  return ++t_locks, lock(mutex);
}
int pthread_rwlock_rdlock(pthread_rwlock_t* rwlock) {
  static const auto lock = real<int (*)(pthread_rwlock_t*)>("pthread_rwlock_rdlock");
  return ++t_locks, lock(rwlock);
}
int pthread_rwlock_wrlock(pthread_rwlock_t* rwlock) {
  static const auto lock = real<int (*)(pthread_rwlock_t*)>("pthread_rwlock_wrlock");
  return ++t_locks, lock(rwlock);
}
}

namespace afm::node {
namespace {

constexpr int kBatches = 400;
const double kCommands[] = {3.4, 0.0, 1.0, -3.4, 2.0, 3.0, 1e-4, 0.34, -30.0, 5.0};

// What the stepping thread does between two deadlines: obey, step, hand over, now and then its whole state. A reader on
// its own side takes all away.
class SteppingPath {
 public:
  explicit SteppingPath(ModelKind kind, double cutoff)
      : emulator_(settings(kind, cutoff)), hand_over_({64, 64 * 400, 400000}) {
    emulator_.reserve(batch_);
    emulator_.reserve(taken_);
  }

  void step(int n) {
    if (n % 10 == 0) emulator_.drag(kCommands[(n / 10) % 10]);
    if (n % 97 == 0) emulator_.reset();
    emulator_.run_batch(batch_);
    impacts_ += batch_.impacts.size();
    Event event;
    event.state.time = emulator_.now();
    dropped_ += hand_over_.offer(event, batch_) ? 0 : 1;
    if (n % 5 != 0) return;
    emulator_.save(state_);
    dropped_ += hand_over_.offer(event, state_) ? 0 : 1;
  }
  void take_away() {
    Event event;
    while (hand_over_.take(event, taken_, taken_state_)) {
    }
  }
  std::size_t impacts() const { return impacts_; }
  int dropped() const { return dropped_; }

 private:
  static EmulatorSettings settings(ModelKind kind, double cutoff) {
    EmulatorSettings s;
    s.model.kind = kind;
    s.model.v_c = cutoff;
    s.samples_per_batch = 400;
    return s;
  }

  Emulator emulator_;
  HandOver hand_over_;
  Batch batch_, taken_;
  SavedState state_, taken_state_;
  std::size_t impacts_ = 0;
  int dropped_ = 0;
};

std::vector<SteppingPath*> all_paths() {
  return {new SteppingPath(ModelKind::oscillator, 0.05), new SteppingPath(ModelKind::oscillator, 0.0),
          new SteppingPath(ModelKind::hammer, 0.05)};
}

TEST(SteppingPath, TheHooksCount) {
  pthread_mutex_t mutex = PTHREAD_MUTEX_INITIALIZER;
  pthread_mutex_lock(&mutex);  // once before counting: the first call looks up the C library's, and dlsym may allocate
  pthread_mutex_unlock(&mutex);
  const long allocations = t_allocations, locks = t_locks;
  std::vector<int>* volatile something = new std::vector<int>(10);
  delete something;
  pthread_mutex_lock(&mutex);
  pthread_mutex_unlock(&mutex);
  EXPECT_EQ(t_allocations - allocations, 4);
  EXPECT_EQ(t_locks - locks, 1);
}

TEST(SteppingPath, NeitherAllocatesNorLocks) {
  for (SteppingPath* path : all_paths()) {
    long allocations = 0, locks = 0;
    for (int n = 0; n < kBatches; ++n) {
      const long allocations_before = t_allocations, locks_before = t_locks;
      path->step(n);
      allocations += t_allocations - allocations_before;
      locks += t_locks - locks_before;
      path->take_away();
    }
    EXPECT_EQ(allocations, 0);
    EXPECT_EQ(locks, 0);
    EXPECT_GT(path->impacts(), 1000u);
    EXPECT_EQ(path->dropped(), 0);
  }
}

// In a child of ours that the kernel kills at any call but the one that ends it.
template <class Function>
int run_without_system_calls(const Function& function) {
  const pid_t child = fork();
  if (child == 0) {
    if (prctl(PR_SET_SECCOMP, SECCOMP_MODE_STRICT) != 0) syscall(SYS_exit, 77);
    function();
    syscall(SYS_exit, 0);
  }
  int status = 0;
  waitpid(child, &status, 0);
  return status;
}

TEST(SteppingPath, CallsNoSystem) {
  const int allowed = run_without_system_calls([] {});
  if (WIFEXITED(allowed) && WEXITSTATUS(allowed) == 77) GTEST_SKIP() << "no seccomp here";
  const int forbidden = run_without_system_calls([] { syscall(SYS_getpid); });
  ASSERT_TRUE(WIFSIGNALED(forbidden) && WTERMSIG(forbidden) == SIGKILL) << "seccomp does not kill";
  for (SteppingPath* path : all_paths()) {
    for (int n = 0; n < 20; ++n) {  // pages are touched for the first time before they count
      path->step(n);
      path->take_away();
    }
    const int status = run_without_system_calls([path] {
      for (int n = 0; n < kBatches; ++n) {
        path->step(n);
        path->take_away();
      }
    });
    EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0) << "killed by signal " << WTERMSIG(status);
  }
}

}  // namespace
}  // namespace afm::node
