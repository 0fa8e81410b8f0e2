// The service side of the stepping thread: asks, and waits until it was done and published, or says why not.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <map>
#include <mutex>
#include <optional>
#include <string>

#include "node/stepping/events.h"
#include "node/stepping/stepper.h"

namespace afm::node {

struct ControlReply {
  bool success = false;
  std::string message;
  ModelTime time;
};

class Control {
 public:
  explicit Control(Stepper& stepper) : stepper_(stepper) {}

  ControlReply pause(bool paused);
  ControlReply reset();
  ControlReply change(const LiveParameters& live);
  ControlReply catch_up();  // all that was emulated before this is published
  ControlReply step(double tau, std::uint32_t impacts);  // exactly one of them is not 0

  void deliver(const Answer& answer);  // from the publishing thread, in its place among what it publishes
  void close();                        // from now on every caller learns that the node ends

 private:
  ControlReply ask(Request request, const std::string& done);
  std::optional<Answer> wait_for(std::uint64_t ticket);

  Stepper& stepper_;
  std::mutex mutex_;
  std::condition_variable delivered_;
  bool closed_ = false;
  std::uint64_t last_ticket_ = 0;
  std::map<std::uint64_t, std::optional<Answer>> waiting_;  // those whose askers have gone are not in it
};

}  // namespace afm::node
