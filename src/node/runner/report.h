// Requests to the running thread and its reports: plain values, which travel through lock-free queues. Whoever waits
// for an answer waits on a future, which the publisher fulfils when all that the answer stands for is published.
#pragma once

#include <atomic>
#include <boost/lockfree/spsc_queue.hpp>
#include <boost/lockfree/stack.hpp>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <future>
#include <limits>
#include <memory>
#include <vector>

#include "afm/run.h"
#include "node/params/parameters.h"
#include "threads.h"

namespace afm::node {

// Control periods under way at once, in real time: of as many controllers.
constexpr std::size_t kMaxPeriods = 8;
constexpr double kAsItIs = std::numeric_limits<double>::quiet_NaN();

// Sums over a control period, in natural units.
struct Measured {
  ModelTime begin;
  std::uint64_t samples = 0;
  double vertical = 0.0, vertical_squares = 0.0;  // of y - y0
  double lateral_squares = 0.0;                   // of x - xc
  double impulse = 0.0;                           // of the holder's lateral force, exact
  std::uint64_t bounces = 0;
  double energy_loss = 0.0;
  double drag_velocity = 0.0;  // [m/s]; NaN: it changed meanwhile

  void add(const Batch& batch) {
    samples += batch.vertical.size();
    for (const double y : batch.vertical) vertical += y, vertical_squares += y * y;
    for (const double x : batch.lateral) lateral_squares += x * x;
    impulse += batch.impulse;
    for (const Impact& impact : batch.impacts) bounces += impact.count, energy_loss += impact.energy_loss;
  }
};

struct Answer {
  const char* fault = "";     // why the request was not done, or empty
  ModelTime time;             // reached
  std::uint64_t impacts = 0;  // taken by a step
  // of a control period
  Measured measured;
  std::uint32_t epoch = 0;
  std::uint64_t number = 0;  // of the last `applied`
};
using Reply = std::shared_ptr<std::promise<Answer>>;

struct Request {
  enum class Kind : std::uint8_t { command, change, pause, resume, reset, step, control, snapshot, flush };
  explicit Request(Kind of_kind = Kind::flush) : kind(of_kind) {}

  Kind kind;
  const char* cause = "";                                 // of a command, as `applied` reports it
  double drag_velocity = kAsItIs, rest_height = kAsItIs;  // [m/s], [m]; of a command, a control period
  double tau = 0.0;                                       // to advance, by a step or in a control period
  std::uint64_t impacts = 0;                              // of a step, if tau is 0
  Live live;                                              // of a change: live parameters, or kAsItIs
  Reply reply;                                            // empty: nobody waits
};

// How the running thread is doing.
struct RunnerState {
  std::uint32_t epoch = 0;
  ModelTime time;
  std::uint64_t impacts = 0, samples = 0;  // of this epoch so far
  double real_time_factor = 1.0;
  double lag = 0.0, worst_lag = 0.0;  // [s]
  std::uint64_t batches = 0, late_batches = 0;
  Counters counters;
  bool paused = false;
  bool timed_out = false;  // the drag was stopped as no drag velocity came
};

// The settings in force since the last report of kind `applied`.
struct InForce {
  Live live;  // to the bit as it was commanded
  Level level;
  double expected_error = std::numeric_limits<double>::quiet_NaN();  // of the level; NaN: not known, or not asked for
  double energy_dropped = 0.0;                                       // on the way to the level [m_tip a^2/tau^2]
  const char* cause = "";    // epoch, parameters, scene, timeout, or that of a command
  std::uint64_t number = 0;  // of the report in its epoch
};

struct Report {
  enum class Kind : std::uint8_t { epoch, applied, snapshot, batch, answer };
  Kind kind = Kind::batch;
  std::uint64_t wall_ns = 0;  // wall clock [ns since 1970]
  InForce in_force;
  RunnerState state;
  Batch* batch = nullptr;  // of kind batch; it belongs to the receiver, who gives it back
  bool unhurried = false;  // made while paused or in lockstep: it may wait for slow subscribers and a slow disk
  Snapshot snapshot;       // of kind snapshot
  Answer answer;           // of kind answer
  Reply reply;             // to be fulfilled when this is published
};

// From the running thread to the publisher: one queue of reports in order, and a pool of the batches in them. The
// running side never blocks, locks or allocates; what finds no room is refused there.
class BatchQueue {
 public:
  // So many batches like this one, which is empty and has room for the largest.
  BatchQueue(std::size_t batches, const Batch& preallocated)
      : batches_(batches), free_(batches), reports_(batches + kReserved + kWaitingRequests) {
    for (Batch& batch : batches_) {
      batch.vertical.reserve(preallocated.vertical.capacity());
      batch.lateral.reserve(preallocated.lateral.capacity());
      batch.impacts.reserve(preallocated.impacts.capacity());
      free_.bounded_push(&batch);
    }
    // a page touched for the first time costs the toucher a fault: touch them all before the running thread does
    while (reports_.push(Report{})) {
    }
    reports_.reset();
  }

  // The running side.
  Batch* acquire() {  // null: none is free
    Batch* batch = nullptr;
    if (free_.pop(batch)) ++acquired_;
    return batch;
  }
  // All batches are: whoever listens may have seen them.
  bool is_published() const { return released_.load(std::memory_order_acquire) == acquired_; }
  bool offer(const Report& report) {
    if (!reports_.push(report)) return false;
    available_.post();
    return true;
  }
  // For all that a request can cause. Requests leave room for batches and for the answers of control periods, so a
  // flood of commands drops none.
  bool has_room_for_request() const { return reports_.write_available() >= batches_.size() + kReserved; }

  // The publishing side.
  void wait_for(std::chrono::milliseconds timeout) { available_.wait_for(timeout); }
  bool take(Report& report) { return reports_.pop(report); }
  void release(Batch* batch) {
    free_.bounded_push(batch);
    released_.fetch_add(1, std::memory_order_release);
  }

 private:
  static constexpr std::size_t kReportsPerRequest = 5;  // a reset: epoch, applied, snapshot, batch, answer
  static constexpr std::size_t kReserved = kReportsPerRequest + kMaxPeriods;
  static constexpr std::size_t kWaitingRequests = 1024;  // that may wait for publication

  std::vector<Batch> batches_;
  boost::lockfree::stack<Batch*> free_;  // last in, first out: memory that is seldom needed stays untouched
  boost::lockfree::spsc_queue<Report> reports_;
  std::uint64_t acquired_ = 0;  // of the running side
  std::atomic<std::uint64_t> released_{0};
  Semaphore available_;
};

}  // namespace afm::node
