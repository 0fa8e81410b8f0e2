// emulator_node: the AFM tip on the wire. Exits 1 if its parameters are faulty, 0 when it is ordered to end.
#include <malloc.h>
#include <ros/console.h>
#include <ros/init.h>
#include <ros/spinner.h>

#include <atomic>
#include <csignal>
#include <exception>

#include "emulator_node.h"
#include "node/runner/threads.h"

namespace {

// A step may hold one service for seconds: others, and commands, must come through meanwhile.
constexpr unsigned kSpinnerThreads = 3;
// How soon a shutdown by ROS (rosnode kill) is noticed.
constexpr std::chrono::milliseconds kShutdownPoll{100};
constexpr int kLargeBuffer = 256 * 1024;  // [bytes] more than a message of 10 ms takes, at up to a million samples a second

std::atomic<bool> g_running{false}, g_stop{false};
afm::node::Semaphore g_signalled;

// roscpp handles SIGINT alone and tears the connections down at once; we end in our own order, on SIGTERM too.
extern "C" void on_signal(int) {
  g_stop = true;
  g_signalled.post();
  if (!g_running) ros::requestShutdown();  // it may be waiting for a master
}

void handle_signals() {
  struct sigaction action {};
  action.sa_handler = on_signal;
  action.sa_flags = SA_RESTART;
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
}

// One heap: each of a thread's own keeps back what was freed into it, 10 MB in the course of some recordings. The
// running thread, which must not wait for another, allocates nothing. And large buffers, as of bags and of bursts,
// never come from the heap: left to itself, the allocator takes the first that is freed as a sign to keep all.
void keep_memory_flat() {
  mallopt(M_ARENA_MAX, 1);
  mallopt(M_MMAP_THRESHOLD, kLargeBuffer);
}

void run(const ros::NodeHandle& handle, const afm::node::Parameters& parameters) {
  ros::AsyncSpinner spinner(kSpinnerThreads);  // outlives the node: its services end while they can still be served
  afm::node::EmulatorNode node(handle, parameters);
  spinner.start();
  g_running = true;
  while (ros::ok() && !g_stop) g_signalled.wait_for(kShutdownPoll);
}

}  // namespace

int main(int argc, char** argv) {
  keep_memory_flat();
  ros::init(argc, argv, "afm", ros::init_options::NoSigintHandler);
  handle_signals();
  const ros::NodeHandle handle("~");  // roscpp shuts down with its last handle
  afm::node::Faults faults;
  const auto parameters = afm::node::load_parameters(handle, faults);
  if (!faults.empty()) {
    ROS_FATAL_STREAM("faulty parameters:\n" << describe(faults));
    return 1;
  }
  try {
    run(handle, parameters);
  } catch (const std::exception& error) {
    ROS_FATAL("%s", error.what());
    return 1;
  }
  return 0;
}
