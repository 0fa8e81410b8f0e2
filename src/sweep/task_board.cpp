#include "task_board.h"

#include <utility>

namespace afm {

std::deque<SweepTask> tasks_left(const SweepGrid& grid, const std::map<std::size_t, PackedResult>& found) {
  std::deque<SweepTask> tasks;
  for (std::size_t begin = 0; begin < grid.size(); begin += grid.chain_length()) {
    SweepTask task{begin, begin + grid.chain_length(), false, {}};
    for (auto done = found.find(task.first); done != found.end() && task.first < task.end;
         done = found.find(task.first)) {
      task.start = unpack(done->second).end;
      task.carried = ++task.first > begin;
    }
    if (task.first < task.end) tasks.push_back(task);
  }
  return tasks;
}

void do_work(WorkSource& source, const SweepGrid& grid, const SweepSettings& settings) {
  while (auto task = source.take()) {
    for (; task->first < task->end; ++task->first) {
      const SweepPoint point = grid.at(task->first);
      if (!task->carried) task->start = random_start(point, settings.seed, task->first);
      SweepSettings own = settings;
      own.bath.stream = task->first;
      const SweepResult result = sweep_point(point, own, task->start);
      source.deliver({task->first, result});
      task->start = result.end;
      task->carried = true;
    }
  }
}

std::optional<SweepTask> TaskBoard::take() {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (tasks_.empty()) return {};
  const SweepTask task = tasks_.front();
  tasks_.pop_front();
  return task;
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
