#include "sweep/task_board.h"

#include <utility>

namespace afm {

void do_work(WorkSource& source, const SweepGrid& grid, const SweepSettings& settings) {
  SweepTask task;
  while (source.take(task)) {
    TipState start = task.carried ? task.start : random_start(grid.at(task.first), settings.seed, task.first);
    for (std::size_t position = task.first; position < task.end; ++position) {
      const SweepDone done{position, sweep_point(grid.at(position), settings, start)};
      start = done.result.end;
      source.deliver(done);
    }
  }
}

bool TaskBoard::take(SweepTask& task) {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (tasks_.empty()) return false;
  task = tasks_.front();
  tasks_.pop_front();
  return true;
}

void TaskBoard::deliver(const SweepDone& done) {
  const std::lock_guard<std::mutex> lock(mutex_);
  done_.push_back(done);
  delivered_.notify_one();
}

std::vector<SweepDone> TaskBoard::collect(std::chrono::milliseconds patience) {
  std::unique_lock<std::mutex> lock(mutex_);
  delivered_.wait_for(lock, patience, [this] { return !done_.empty(); });
  return std::exchange(done_, {});
}

}  // namespace afm
