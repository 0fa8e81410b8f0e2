// The running thread neither allocates nor locks, and calls the system only to sleep and to wake the publisher. A real
// one runs here under every kind of request: its allocations and locks are counted, and in a child the kernel has
// orders to kill for any other call.
#include <dlfcn.h>
#include <gtest/gtest.h>
#include <linux/audit.h>
#include <linux/filter.h>
#include <linux/seccomp.h>
#include <pthread.h>
#include <semaphore.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <string>
#include <vector>

#include "node/runner/runner.h"

namespace {

thread_local bool t_watched = false, t_restricted = false;  // the running thread; under the kernel's orders
std::atomic<bool> g_counting{false}, g_restrict{false};
std::atomic<long> g_allocations{0}, g_locks{0};

void count(std::atomic<long>& number) {
  if (t_watched && g_counting) ++number;
}

template <class Function>
Function real(const char* name) {
  return reinterpret_cast<Function>(dlsym(RTLD_NEXT, name));
}

// From here on the calling thread may sleep, wake another, and read the clock, where that takes a call.
void restrict_system_calls() {
  sock_filter code[] = {
      BPF_STMT(BPF_LD | BPF_W | BPF_ABS, offsetof(seccomp_data, nr)),
      BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, SYS_clock_nanosleep, 3, 0),
      BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, SYS_futex, 2, 0),
      BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, SYS_clock_gettime, 1, 0),
      BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_KILL_PROCESS),
      BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ALLOW),
  };
  const sock_fprog program{sizeof code / sizeof code[0], code};
  prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0);
  if (prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, &program) != 0) _exit(77);
}

// Where the running thread waits.
void restrict_if_asked() {
  if (!t_watched || !g_restrict || t_restricted) return;
  t_restricted = true;
  restrict_system_calls();
}

}  // namespace

// These stand before the C library's for the whole program, and for its libraries: operator new comes through here too.
extern "C" {
void* __libc_malloc(std::size_t);
void* __libc_calloc(std::size_t, std::size_t);
void* __libc_realloc(void*, std::size_t);
void __libc_free(void*);
void* malloc(std::size_t size) { return count(g_allocations), __libc_malloc(size); }
void* calloc(std::size_t number, std::size_t size) { return count(g_allocations), __libc_calloc(number, size); }
void* realloc(void* old, std::size_t size) { return count(g_allocations), __libc_realloc(old, size); }
void free(void* memory) { count(g_allocations), __libc_free(memory); }
int pthread_mutex_lock(pthread_mutex_t* mutex) {
  static const auto lock = real<int (*)(pthread_mutex_t*)>("pthread_mutex_lock");
  return count(g_locks), lock(mutex);
}
int pthread_mutex_trylock(pthread_mutex_t* mutex) {
  static const auto lock = real<int (*)(pthread_mutex_t*)>("pthread_mutex_trylock");
  return count(g_locks), lock(mutex);
}
int pthread_rwlock_rdlock(pthread_rwlock_t* rwlock) {
  static const auto lock = real<int (*)(pthread_rwlock_t*)>("pthread_rwlock_rdlock");
  return count(g_locks), lock(rwlock);
}
int pthread_rwlock_wrlock(pthread_rwlock_t* rwlock) {
  static const auto lock = real<int (*)(pthread_rwlock_t*)>("pthread_rwlock_wrlock");
  return count(g_locks), lock(rwlock);
}
int pthread_setname_np(pthread_t thread, const char* name) {
  static const auto set = real<int (*)(pthread_t, const char*)>("pthread_setname_np");
  t_watched = std::strcmp(name, "afm_run") == 0;
  return set(thread, name);
}
int clock_nanosleep(clockid_t clock, int flags, const timespec* until, timespec* rest) {
  static const auto sleep = real<int (*)(clockid_t, int, const timespec*, timespec*)>("clock_nanosleep");
  restrict_if_asked();
  return sleep(clock, flags, until, rest);
}
int sem_clockwait(sem_t* semaphore, clockid_t clock, const timespec* until) {
  static const auto wait = real<int (*)(sem_t*, clockid_t, const timespec*)>("sem_clockwait");
  restrict_if_asked();
  return wait(semaphore, clock, until);
}
}

namespace afm::node {
namespace {

using Kind = Request::Kind;

std::vector<Parameters> runs() {
  Parameters cold, every_bounce, hammer, warm, lockstep;
  cold.commands_eta = {3.4, 0.0, 1.0, -3.4, 2.0, 3.0, 1e-4, 0.34, -30.0, 5.0};  // a scene's
  cold.commands_hold_s = 0.01;
  every_bounce.si.cutoff_speed = 0.0;
  hammer.model = "hammer";
  warm.bath.temperature_k = 300.0;
  warm.bath.quality_factor = 100.0;
  lockstep.pace = kLockstep;
  std::vector<Parameters> all{cold, every_bounce, hammer, warm, lockstep};
  for (Parameters& p : all) p.batch_rate_hz = 1000.0;
  return all;
}

// A running thread and a reader on its own side, which takes all away.
class Reader {
 public:
  explicit Reader(const Parameters& p) : p_(p), queue_(64, preallocated_batch(p)), runner_(p, queue_) {
    runner_.start();
    read_for(50);  // pages are touched for the first time before they count
  }

  // Requests of every kind, some milliseconds apart.
  void steer() {
    Live live = p_;
    live.si.restitution_gamma = 0.5;
    live.sample_rate_hz = 1e5;
    live.bath.temperature_k = 77.0;
    std::vector<Request> requests;
    for (const Kind kind : {Kind::command, Kind::command, Kind::change, Kind::snapshot, Kind::pause, Kind::step,
                            Kind::step, Kind::resume, Kind::reset, Kind::flush, Kind::control}) {
      requests.emplace_back(kind);
    }
    requests[0].drag_velocity = -2.0 * Units(p_.si).velocity();
    requests[1].rest_height = -1e-11;
    requests[2].live = live;
    requests[5].tau = 20.0;
    requests[6].impacts = 10;
    requests[10].cause = "drag_velocity";
    requests[10].drag_velocity = 3.4 * Units(p_.si).velocity();
    requests[10].tau = 500.0;
    for (int round = 0; round < 3; ++round) {
      for (Request& request : requests) {
        request.reply = std::make_shared<std::promise<Answer>>();
        runner_.submit(request);
        read_for(10);
      }
    }
  }
  void read_for(int milliseconds) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::milliseconds(milliseconds);
    Report report;
    while (std::chrono::steady_clock::now() < end) {
      queue_.wait_for(std::chrono::milliseconds(1));
      while (queue_.take(report)) {
        impacts_ = std::max(impacts_, report.state.impacts);
        snapshots_ += report.kind == Report::Kind::snapshot ? 1 : 0;
        if (report.batch != nullptr) queue_.release(report.batch);
      }
    }
  }
  std::uint64_t impacts() const { return impacts_; }
  int snapshots() const { return snapshots_; }

 private:
  const Parameters p_;
  BatchQueue queue_;
  Runner runner_;
  std::uint64_t impacts_ = 0;
  int snapshots_ = 0;
};

TEST(SteppingPath, TheHooksCount) {
  pthread_mutex_t mutex = PTHREAD_MUTEX_INITIALIZER;
  t_watched = true;
  pthread_mutex_lock(&mutex);  // once before counting: the first call looks up the C library's, and dlsym may allocate
  pthread_mutex_unlock(&mutex);
  g_counting = true;
  std::vector<int>* volatile something = new std::vector<int>(10);
  delete something;
  pthread_mutex_lock(&mutex);
  pthread_mutex_unlock(&mutex);
  g_counting = t_watched = false;
  EXPECT_EQ(g_allocations, 4);
  EXPECT_EQ(g_locks, 1);
}

TEST(SteppingPath, NeitherAllocatesNorLocks) {
  for (const Parameters& p : runs()) {
    Reader reader(p);
    g_allocations = g_locks = 0;
    g_counting = true;
    reader.steer();
    g_counting = false;
    EXPECT_EQ(g_allocations, 0);
    EXPECT_EQ(g_locks, 0);
    EXPECT_GT(reader.impacts(), 500u);
    EXPECT_GE(reader.snapshots(), 6);  // asked for, and of every reset
  }
}

// In a child of ours.
template <class Function>
int status_of(const Function& function) {
  const pid_t child = fork();
  if (child == 0) {
    function();
    _exit(0);
  }
  int status = 0;
  waitpid(child, &status, 0);
  return status;
}

TEST(SteppingPath, CallsTheSystemOnlyToSleepAndToWake) {
  const int forbidden = status_of([] {
    restrict_system_calls();
    syscall(SYS_getpid);
  });
  if (WIFEXITED(forbidden) && WEXITSTATUS(forbidden) == 77) GTEST_SKIP() << "no seccomp here";
  ASSERT_TRUE(WIFSIGNALED(forbidden) && WTERMSIG(forbidden) == SIGSYS) << "the kernel does not kill";
  for (const Parameters& p : runs()) {
    const int status = status_of([&p] {
      Reader reader(p);
      g_restrict = true;
      reader.steer();
      _exit(reader.impacts() < 500 ? 1 : 0);  // the running thread may not even end
    });
    EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0)
        << (WIFSIGNALED(status) ? "killed by signal " + std::to_string(WTERMSIG(status)) : "too few impacts");
  }
}

}  // namespace
}  // namespace afm::node
