// Requests to the running thread and its reports: plain values, which travel through lock-free queues. Whoever waits for
// an answer waits on a future, which the publisher fulfils when all that the answer stands for is published.
#pragma once

#include <cstdint>
#include <future>
#include <limits>
#include <memory>

#include "afm/run.h"
#include "node/params/live.h"

namespace afm::node {

// Sums over a control period, in natural units.
struct Measured {
  ModelTime begin;
  std::uint64_t samples = 0;
  double vertical = 0.0, vertical_squares = 0.0;  // of y - y0
  double lateral = 0.0, lateral_squares = 0.0;    // of x - xc
  std::uint64_t bounces = 0;
  double energy_loss = 0.0;

  void add(const Batch& batch) {
    samples += batch.vertical.size();
    for (const double y : batch.vertical) vertical += y, vertical_squares += y * y;
    for (const double x : batch.lateral) lateral += x, lateral_squares += x * x;
    for (const Impact& impact : batch.impacts) bounces += impact.count, energy_loss += impact.energy_loss;
  }
};

struct Answer {
  enum class Result : std::uint8_t { done, not_paused, not_lockstep, time_ran_out, shutting_down };
  Result result = Result::done;
  ModelTime time;             // reached
  std::uint64_t impacts = 0;  // taken by a step
  Measured measured;          // over a control period, like the next three
  std::uint32_t epoch = 0;
  std::uint64_t number = 0;     // of the last `applied`
  double drag_velocity = 0.0;  // in force [m/s]
};
using Reply = std::shared_ptr<std::promise<Answer>>;

struct Request {
  enum class Kind : std::uint8_t {
    drag, rest_height, load, change, pause, resume, reset, step_time, step_impacts, control, snapshot, flush
  };
  Kind kind = Kind::flush;
  double value = 0.0;         // drag velocity [m/s], height [m] or time to advance [tau]
  std::uint64_t impacts = 0;  // to step
  Live live;                  // of kind change, all but the drag velocity; of kind control that and the rest height
  Reply reply;                // empty: nobody waits
};

// Why something took effect.
enum class Cause : std::uint8_t { epoch, drag_velocity, rest_height, load, parameters, scene, timeout };

// How the running thread is doing.
struct RunnerState {
  std::uint32_t epoch = 0;
  ModelTime time;
  std::uint64_t impacts = 0, samples = 0;  // of this epoch so far
  double real_time_factor = 1.0;
  double lag = 0.0, worst_lag = 0.0;  // [s]
  std::uint64_t batches = 0, late_batches = 0;
  std::uint64_t dropped_batches = 0;  // emulated, but the publisher had no room for them
  Counters counters;
  bool paused = false;
  std::uint64_t unanswered_batches = 0;  // in lockstep: they went on without the command that they waited for
  bool timed_out = false;  // the drag was stopped as no command came
};

// The level of the model in force.
struct AppliedLevel {
  Level level;
  double expected_error = std::numeric_limits<double>::quiet_NaN();  // NaN: not known, or not asked for
  double energy_dropped = 0.0;                                       // on the way to it [m a^2/tau^2]
};

struct Report {
  enum class Kind : std::uint8_t { epoch, applied, snapshot, batch, answer };
  Kind kind = Kind::batch;
  std::int64_t wall_ns = 0;  // wall clock [ns since 1970]
  Live live;                 // in force, to the bit as it was commanded
  AppliedLevel level;        // likewise
  Cause cause = Cause::epoch;
  std::uint64_t number = 0;  // of the last `applied` in its epoch
  RunnerState state;
  Batch* batch = nullptr;    // of kind batch; it belongs to the receiver, who gives it back
  bool unhurried = false;    // made while stepping: it may wait for slow subscribers
  Snapshot snapshot;         // of kind snapshot
  Answer answer;             // of kind answer
  Reply reply;               // to be fulfilled when this is published
};

}  // namespace afm::node
