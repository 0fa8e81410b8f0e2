// The messages of a topic that roscpp still holds for its subscribers. It says neither how full the queue of a subscriber is
// nor what it drops from one; but it lets go of the bytes of a message when the last subscriber has them, or has lost them.
#pragma once

#include <ros/serialization.h>

#include <cstdint>
#include <memory>
#include <mutex>
#include <set>
#include <utility>

namespace afm::node {

class Outstanding {
 public:
  // The same message, whose bytes report when they are let go.
  ros::SerializedMessage track(ros::SerializedMessage message) {
    const std::uint64_t number = next_++;
    {
      const std::lock_guard<std::mutex> lock(state_->mutex);
      state_->held.insert(number);
    }
    message.buf = boost::shared_array<std::uint8_t>(
        message.buf.get(), [bytes = message.buf, state = state_, number](std::uint8_t*) { state->let_go(number); });
    return message;
  }

  std::size_t count() const {
    const std::lock_guard<std::mutex> lock(state_->mutex);
    return state_->held.size();
  }
  std::uint64_t oldest() const {  // its number, or that of the next message
    const std::lock_guard<std::mutex> lock(state_->mutex);
    return state_->held.empty() ? next_ : *state_->held.begin();
  }
  // Since this was last asked.
  std::uint64_t take_lost() {
    const std::lock_guard<std::mutex> lock(state_->mutex);
    return std::exchange(state_->lost, 0);
  }

 private:
  struct State {
    // Each subscriber gets its messages in order, and the one that is being sent is held: what is let go before an older
    // one was dropped.
    void let_go(std::uint64_t number) {
      const std::lock_guard<std::mutex> lock(mutex);
      if (*held.begin() < number) ++lost;
      held.erase(number);
    }
    std::mutex mutex;
    std::set<std::uint64_t> held;
    std::uint64_t lost = 0;
  };

  std::uint64_t next_ = 0;
  const std::shared_ptr<State> state_ = std::make_shared<State>();
};

}  // namespace afm::node
