// From the running thread to the publisher: one queue of reports in order, and a pool of the batches in them. The
// running side never blocks, locks or allocates; what finds no room is refused there.
#pragma once

#include <boost/lockfree/spsc_queue.hpp>
#include <boost/lockfree/stack.hpp>
#include <chrono>
#include <cstddef>
#include <vector>

#include "report.h"
#include "threads.h"

namespace afm::node {

class BatchQueue {
 public:
  // So many batches like this one, which is empty and has room for the largest.
  BatchQueue(std::size_t batches, const Batch& preallocated)
      : batches_(batches), free_(batches), reports_(batches + kReportsPerRequest + kWaitingRequests) {
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
    free_.pop(batch);
    return batch;
  }
  bool offer(const Report& report) {
    if (!reports_.push(report)) return false;
    available_.post();
    return true;
  }
  // For all that a request can cause. Requests leave room for batches, so a flood of commands drops none.
  bool has_room_for_request() const { return reports_.write_available() >= batches_.size() + kReportsPerRequest; }

  // The publishing side.
  void wait_for(std::chrono::milliseconds timeout) { available_.wait_for(timeout); }
  bool take(Report& report) { return reports_.pop(report); }
  void release(Batch* batch) { free_.bounded_push(batch); }

 private:
  static constexpr std::size_t kReportsPerRequest = 5;   // a reset: epoch, applied, snapshot, batch, answer
  static constexpr std::size_t kWaitingRequests = 1024;  // that may wait for publication

  std::vector<Batch> batches_;
  boost::lockfree::stack<Batch*> free_;  // last in, first out: memory that is seldom needed stays untouched
  boost::lockfree::spsc_queue<Report> reports_;
  Semaphore available_;
};

}  // namespace afm::node
