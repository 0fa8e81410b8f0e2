// The running thread: advances the run batch by batch at absolute deadlines, obeys requests between batches, and reports
// everything. It blocks to wait for the next deadline, or for room to report, and neither locks nor allocates.
#pragma once

#include <atomic>
#include <boost/lockfree/spsc_queue.hpp>
#include <cstdint>
#include <future>
#include <mutex>
#include <string>
#include <thread>

#include "afm/pacer.h"
#include "afm/run.h"
#include "batch_queue.h"
#include "node/params/parameters.h"
#include "semaphore.h"

namespace afm::node {

constexpr double kMaxStepTau = 1e4;  // of one step: 1.6 s of model time at the paper's frequency
constexpr std::uint64_t kMaxStepImpacts = 100000;

class Runner {
 public:
  Runner(const Parameters& parameters, BatchQueue& queue);
  ~Runner() { stop(); }

  void start();  // returns when the thread runs
  void stop();   // at the next batch boundary; requests still waiting are not served

  // Any thread. False: too many requests wait already, and this one was not taken.
  bool submit(const Request& request);

  const std::string& scheduler() const { return scheduler_; }  // after start(): "fifo", or "normal" with the reason

 private:
  void loop();
  void wait_for_work();
  void serve_requests();
  Answer serve(const Request& request);
  void begin_epoch();
  void apply(const Live& live, Cause cause);
  void play_commands();
  void check_timeout();
  bool may_advance();  // in lockstep; false: not before something asks for it
  void take_snapshot();
  void pause(bool paused);
  bool is_held() const { return paused_ || lockstep_; }  // it may be stepped
  Answer step_time(double tau);
  Answer advance_by(double tau);
  Answer step_impacts(std::uint64_t impacts);
  Answer control(const Request& request);
  Answer answer(Answer::Result result, std::uint64_t impacts = 0) const;

  // One batch: advanced by what is given, and reported. An unhurried one waits for room as long as it takes.
  template <class Advance>
  Outcome run_batch(bool unhurried, Advance advance);
  Batch* acquire(bool unhurried);

  Report make_report(Report::Kind kind);
  RunnerState state();

  const Parameters start_;  // from which every epoch begins
  Parameters parameters_;   // in force
  Run run_;
  BatchQueue& queue_;
  Batch spare_;  // what is run without room to report it
  Pacer pacer_;
  AppliedLevel level_;
  Cause cause_ = Cause::epoch;
  std::uint64_t number_ = 0;                  // of the last report of kind `applied` in this epoch
  std::uint64_t commands_played_ = 0;         // of the scene
  std::chrono::nanoseconds last_command_{0};  // when one was last obeyed, on the monotonic clock
  bool timed_out_ = false;                    // and none since the drag was stopped for that
  std::uint32_t epoch_ = 0;
  Measured measured_;  // since it was cleared
  std::uint64_t last_batch_impacts_ = 0;
  std::uint64_t dropped_batches_ = 0;
  double worst_lag_ = 0.0;
  bool paused_;
  const bool lockstep_;
  // in lockstep that waits for commands
  bool command_heard_ = true;  // the first batch needs none
  std::chrono::nanoseconds command_deadline_{0};
  std::uint64_t unanswered_batches_ = 0;

  std::mutex submitting_;  // between those who ask; the running thread does not take it
  boost::lockfree::spsc_queue<Request> requests_;
  Semaphore asked_;
  std::atomic<bool> stopping_{false};
  std::promise<std::string> running_;
  std::string scheduler_;
  std::thread thread_;
};

}  // namespace afm::node
