#include "node/ending.h"

#include <pthread.h>
#include <ros/init.h>

#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <thread>

namespace afm::node {
namespace {

constexpr std::chrono::milliseconds kPoll{20};
constexpr std::chrono::seconds kLeave{2};  // from the master

std::atomic<bool> g_running{false}, g_asked{false}, g_left{false};

// roscpp would wait for a master that hangs. Where the node is asked to end before it runs, roscpp is asked again and
// again, as it may wait for a master to appear.
void leave_unless(const std::atomic<bool>& done, bool is_asked) {
  const auto end = std::chrono::steady_clock::now() + kLeave;
  for (; !done; std::this_thread::sleep_for(kPoll)) {
    if (is_asked) ros::requestShutdown();
    if (std::chrono::steady_clock::now() < end) continue;
    std::fputs("no answer comes: left without telling the master\n", stderr);
    std::_Exit(0);
  }
}

}  // namespace

// roscpp handles SIGINT alone and tears the connections down at once. One thread waits for the signals, and all others
// are spared: a signal would interrupt a call to the master, which would then seem not to answer.
void await_signals() {
  std::signal(SIGXFSZ, SIG_IGN);  // a file that may grow no further ends a recording, as a full disk does
  sigset_t signals;
  sigemptyset(&signals);
  sigaddset(&signals, SIGINT);
  sigaddset(&signals, SIGTERM);
  struct sigaction at_start {};
  sigaction(SIGHUP, nullptr, &at_start);
  if (at_start.sa_handler != SIG_IGN) sigaddset(&signals, SIGHUP);  // its terminal is closed, and there is no nohup
  pthread_sigmask(SIG_BLOCK, &signals, nullptr);
  std::thread([signals] {
    int unused = 0;
    sigwait(&signals, &unused);
    g_asked = true;
    leave_unless(g_running, true);
  }).detach();
}

void now_running() { g_running = true; }
bool is_asked_to_end() { return g_asked; }

void begin_leaving() {
  std::fflush(nullptr);
  std::thread([] { leave_unless(g_left, false); }).detach();
}

void has_left() { g_left = true; }

}  // namespace afm::node
