// The running thread: advances the run batch by batch at absolute deadlines, serves requests between batches, and
// reports everything. It blocks to wait for the next deadline, or for room to report, and neither locks nor allocates.
#pragma once

#include <atomic>
#include <boost/container/static_vector.hpp>
#include <boost/lockfree/spsc_queue.hpp>
#include <cstdint>
#include <future>
#include <mutex>
#include <string>
#include <thread>

#include "afm/pacer.h"
#include "afm/run.h"
#include "node/params/parameters.h"
#include "report.h"
#include "threads.h"

namespace afm::node {

constexpr double kMaxStepTau = 1e4;    // of one step: 1.6 s of model time at the paper's frequency
constexpr double kMaxPeriodTau = 1e9;  // of a control period in real time: 1.8 days
constexpr std::uint64_t kMaxStepImpacts = 100000;
// Faults of an answer: the step went as far as it says.
constexpr char kWallTimeRanOut[] = "8 s of wall time ran out", kModelTimeRanOut[] = "10000 tau ran out";

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
  using Time = std::chrono::nanoseconds;  // on the monotonic clock

  // A control period under way. In real time it is over with the batch that reaches its end, and answered then.
  struct Period {
    Measured measured;
    ModelTime end;
    Reply reply;  // in real time
  };

  void loop();
  void wait_for_work();
  bool may_advance();
  void await_command();
  void stop_drag_without_commands();
  void play_commands();
  ModelTime time_after(double tau) const;  // from now(), at a sample if one is as near as rounding
  double samples(double count) const;      // the time of so many [tau]

  void serve_requests();
  Answer serve(Request& request);
  void begin_epoch();
  void command(const Request& request);
  void change(const Request& request);
  void apply(const Live& live, const char* cause);
  void take_snapshot();
  void pause(bool paused);
  Answer step(const ModelTime& limit, std::uint64_t impacts);
  Answer control(Request& request);
  template <class Condition>
  void answer_periods(Condition is_over, const char* fault);
  void offer_answer(const Answer& answer, Reply reply);
  Answer answer(const char* fault = "") const;
  Answer answer_of(const Period& period, Answer reached) const;

  // One batch: advanced by what is given, and reported.
  template <class Advance>
  Outcome run_batch(Advance advance);
  void run_batch_to(const ModelTime& limit, std::uint64_t impacts);  // to the next boundary at the latest

  bool is_held() const { return state_.paused || lockstep_; }  // it may be stepped
  Report make_report(Report::Kind kind);
  void update_state();

  const Parameters start_;  // from which every epoch begins
  Parameters parameters_;   // in force
  Run run_;
  BatchQueue& queue_;
  Pacer pacer_;
  RunnerState state_;
  InForce in_force_;
  std::uint64_t applied_ = 0;          // reports of kind `applied` in this epoch
  std::uint64_t commands_played_ = 0;  // of the scene
  Time last_command_{0};               // of a drag velocity
  Time paused_at_{0};
  boost::container::static_vector<Period, kMaxPeriods> periods_;
  const bool lockstep_;
  // in lockstep that waits for commands
  bool awaits_command_ = false;  // the last batch is published: until command_deadline_
  bool command_came_ = false;
  Time command_deadline_{0};

  std::mutex submitting_;  // between those who submit; the running thread does not take it
  boost::lockfree::spsc_queue<Request> requests_;
  Semaphore submitted_;
  std::atomic<bool> stopping_{false};
  std::promise<std::string> running_;
  std::string scheduler_;
  std::thread thread_;
};

}  // namespace afm::node
