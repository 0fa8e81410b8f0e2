// What the operating system lets a real-time thread have.
#pragma once

#include <chrono>
#include <cstdint>
#include <string>

namespace afm::node {

// Raises the calling thread to SCHED_FIFO with locked memory where that is permitted. Returns what came of it:
// "fifo", "fifo, ..." with what is missing, or "normal: " and the reason.
std::string claim_real_time();

// One step below it, where that is permitted: for a thread that must carry off what the real-time thread makes.
void follow_real_time();

// Names the calling thread for top -H and debuggers: 15 letters at most.
void name_thread(const char* name);

// The wall clock, in nanoseconds since 1970.
std::int64_t wall_now_ns();

// Time on the monotonic clock.
std::chrono::nanoseconds monotonic_now();
void sleep_until(std::chrono::nanoseconds deadline);

}  // namespace afm::node
