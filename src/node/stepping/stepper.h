// The stepping thread: advances the emulator batch by batch at absolute deadlines, obeys requests between batches, and
// hands everything over. It blocks to wait for the next deadline, or for room to report a batch, and neither locks nor
// allocates.
#pragma once

#include <atomic>
#include <boost/lockfree/spsc_queue.hpp>
#include <cstdint>
#include <future>
#include <mutex>
#include <string>
#include <thread>

#include "afm/emulator.h"
#include "afm/pacer.h"
#include "events.h"
#include "hand_over.h"
#include "node/parameters/parameters.h"
#include "sample_demand.h"
#include "semaphore.h"

namespace afm::node {

class Stepper {
 public:
  Stepper(const Parameters& parameters, HandOver& hand_over, const SampleDemand& demand);
  ~Stepper() { stop(); }

  void start();  // returns when the thread runs
  void stop();   // at the next batch boundary; requests still waiting are not served

  // Any thread. False: too many requests wait already, and this one was not taken.
  bool submit(const Request& request);

  const std::string& scheduler() const { return scheduler_; }  // after start(): "fifo", or "normal" with the reason

 private:
  // How soon room for another batch is noticed. Publishing takes a batch in well under this.
  static constexpr std::chrono::milliseconds kRoomLook{1};

  void run();
  void wait_for_work();
  void serve_requests();
  bool keep_few_to_remember();  // takes a checkpoint if it must; false: no room for it
  void serve(const Request& request);
  void apply_drag(double drag_velocity);
  void take_level(double eta);
  void apply_change(const LiveParameters& live);
  void lift(double rest_height);
  void watch_for_commands();
  void look_for_checkpoint();
  bool take_checkpoint();  // false: no room to report it
  void pause(bool paused);
  void reset();
  void run_batch();
  void look_for_demand();
  void publish_start();
  bool hand_over_batch();  // false: dropped, as nothing is taken up
  void publish(Event::Kind kind, const Answer& answer = {});

  // long steps, chopped into batches
  Answer step_time(double tau);
  Answer step_impacts(std::uint64_t impacts);
  bool hand_over_step();  // waits for room, as a step owes nothing to the clock; false: shutting down
  Answer answer(Answer::Result result, std::uint64_t impacts) const;

  Event event(Event::Kind kind);
  Event batch_event();
  StepperState state();

  Parameters parameters_;  // as they are now
  Emulator emulator_;
  Batch batch_;
  HandOver& hand_over_;
  const SampleDemand& demand_;
  std::uint32_t stretch_ = 0;  // of samples, to which the batch belongs
  Pacer pacer_;
  double drag_velocity_;  // in force [m/s]
  AppliedLevel level_;
  std::chrono::nanoseconds last_command_{0};  // when one was last obeyed, on the monotonic clock
  bool timed_out_ = false;                    // and none since the drag was stopped for that
  std::uint64_t commands_ = 0;                // applied in this epoch
  SavedState saved_;
  std::uint64_t commands_since_saved_ = 0;  // changes of parameters too
  ModelTime saved_time_;
  std::chrono::nanoseconds checkpoint_due_{0};  // on the monotonic clock
  std::uint32_t epoch_ = 0;
  std::uint64_t dropped_batches_ = 0;
  double worst_lag_ = 0.0;
  bool paused_ = false;

  std::mutex submitting_;  // between those who ask; the stepping thread does not take it
  boost::lockfree::spsc_queue<Request> requests_;
  Semaphore asked_;
  std::atomic<bool> stopping_{false};
  std::promise<std::string> running_;
  std::string scheduler_;
  std::thread thread_;
};

}  // namespace afm::node
