// Requests to the stepping thread and its reports: plain values, so that both travel through lock-free queues.
#pragma once

#include <cstdint>

#include "afm/emulator.h"
#include "node/parameters/applied_level.h"
#include "node/parameters/live_parameters.h"

namespace afm::node {

struct Request {
  enum class Kind : std::uint8_t { drag, rest_height, change, pause, resume, reset, step_time, step_impacts, nothing };
  Kind kind = Kind::drag;
  std::uint64_t ticket = 0;   // names the answer; 0: nobody waits for one
  double value = 0.0;         // drag velocity [m/s], height [m] or time to step [tau]
  std::uint64_t impacts = 0;  // to step
  LiveParameters live;        // of kind change
};

struct Answer {
  enum class Result : std::uint8_t { done, not_paused, time_ran_out, shutting_down };
  Result result = Result::done;
  std::uint64_t ticket = 0;
  ModelTime time;             // reached
  std::uint64_t impacts = 0;  // taken by a step
};

// How the stepping thread is doing.
struct StepperState {
  std::uint32_t epoch = 0;
  ModelTime time;
  std::uint64_t impacts = 0;  // of this epoch, up to then, like the next two
  std::uint64_t samples = 0;
  std::uint64_t commands = 0;  // drag velocities applied
  double real_time_factor = 1.0;
  double lag = 0.0, worst_lag = 0.0;  // [s]
  std::uint64_t batches = 0, late_batches = 0;
  std::uint64_t dropped_batches = 0;  // emulated, but the publishing thread had no room for them
  Counters counters;
  bool paused = false;
  bool timed_out = false;  // the drag was stopped as no command came
};

// The part of a Batch that is not its samples and impacts, of which it holds the numbers.
struct BatchHead {
  ModelTime begin, end, first_sample_time;
  std::uint64_t first_sample = 0, samples = 0;
  std::uint64_t first_impact = 0, impacts = 0;
  FrictionEstimate friction;
  double eta = 0.0;
  std::uint32_t stretch = 0;  // of samples (sample_demand.h); 0: none were taken
};

struct Event {
  enum class Kind : std::uint8_t { reset, drag_applied, parameters_applied, batch, checkpoint, answer };
  Kind kind = Kind::batch;
  std::int64_t wall_ns = 0;    // wall clock [ns since 1970]
  double drag_velocity = 0.0;  // in force [m/s], to the bit as it was commanded
  LiveParameters live;         // in force
  AppliedLevel level;          // likewise
  StepperState state;
  BatchHead batch;  // of kind batch
  Answer answer;    // of kind answer
};

}  // namespace afm::node
