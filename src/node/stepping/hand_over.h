// From the stepping thread to the publishing thread: a queue of events in order, bounded in memory. The stepping side
// never blocks, locks or allocates; what finds no room is refused there, and the caller decides what that means.
#pragma once

#include <boost/lockfree/spsc_queue.hpp>
#include <chrono>
#include <cstddef>

#include "events.h"
#include "semaphore.h"

namespace afm::node {

class HandOver {
 public:
  struct Capacity {
    std::size_t batches, samples, impacts;
  };
  explicit HandOver(const Capacity& capacity);

  // The stepping side. False: there is no room, and nothing was taken.
  bool offer(Event event, const Batch& batch);
  bool offer(const Event& event);
  bool offer(Event event, const SavedState& state);
  // For all that a request can cause. Requests leave room for batches, so that a flood of commands drops none.
  bool has_room_for_request() const { return events_.write_available() >= room_for_request_; }

  // The publishing side. take: false when there is nothing; `batch` and `state` are filled for an event of their kinds.
  void wait_for(std::chrono::milliseconds timeout) { available_.wait_for(timeout); }
  bool take(Event& event, Batch& batch, SavedState& state);

 private:
  const std::size_t room_for_request_;
  boost::lockfree::spsc_queue<Event> events_;
  boost::lockfree::spsc_queue<double> vertical_, lateral_;
  boost::lockfree::spsc_queue<Impact> impacts_;
  boost::lockfree::spsc_queue<SavedState> states_;
  Semaphore available_;
};

}  // namespace afm::node
