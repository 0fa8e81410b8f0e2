// Work for any number of threads: chains of points out, results in. What comes of a point depends on it and its start
// alone, so the order in which they are done shows nowhere.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <deque>
#include <map>
#include <mutex>
#include <optional>
#include <vector>

#include "grid.h"
#include "packed.h"

namespace afm {

// The points [first, end), each begun where the one before it ended.
struct SweepTask {
  std::size_t first = 0, end = 0;
  bool carried = false;  // the start is the end of the point before `first`; otherwise it is drawn at random
  TipState start;
};

// All of a grid's, without what is found done.
std::deque<SweepTask> tasks_left(const SweepGrid& grid, const std::map<std::size_t, PackedResult>& found);

struct SweepDone {
  std::size_t position = 0;
  SweepResult result;
};

class WorkSource {
 public:
  virtual ~WorkSource() = default;
  virtual std::optional<SweepTask> take() = 0;  // nothing: no more work
  virtual void deliver(const SweepDone& done) = 0;
};

// Takes tasks and does them until there are none.
void do_work(WorkSource& source, const SweepGrid& grid, const SweepSettings& settings);

class TaskBoard : public WorkSource {
 public:
  explicit TaskBoard(std::deque<SweepTask> tasks) : tasks_(std::move(tasks)) {}

  std::optional<SweepTask> take() override;
  void deliver(const SweepDone& done) override;
  std::vector<SweepDone> collect(std::chrono::milliseconds patience);  // what was delivered since, or nothing

 private:
  std::mutex mutex_;
  std::condition_variable delivered_;
  std::deque<SweepTask> tasks_;
  std::vector<SweepDone> done_;
};

}  // namespace afm
