#include "task_board.h"

#include <algorithm>
#include <utility>

namespace afm {

namespace {

SweepTrip next_trip(const SweepTask& task, const SweepGrid& grid, std::uint64_t seed) {
  const SweepPoint point = grid.at(task.first);
  return {point, task.carried ? task.start : random_start(point, seed, task.first)};
}

// The task without its first point, which ended so.
SweepTask rest_of(const SweepTask& task, const TipState& end) { return {task.first + 1, task.end, true, end}; }

}  // namespace

void do_work(WorkSource& source, const SweepGrid& grid, const SweepSettings& settings, std::size_t side_by_side) {
  std::vector<SweepTask> tasks;
  for (bool more = true;;) {
    if (more && tasks.size() < side_by_side) {
      const std::vector<SweepTask> taken = source.take(side_by_side - tasks.size());
      more = !taken.empty();
      tasks.insert(tasks.end(), taken.begin(), taken.end());
    }
    if (tasks.empty()) return;
    std::vector<SweepTrip> trips;
    for (const SweepTask& task : tasks) trips.push_back(next_trip(task, grid, settings.seed));
    const std::vector<SweepResult> results = sweep_points(trips, settings);
    std::vector<SweepTask> left;
    for (std::size_t i = 0; i < tasks.size(); ++i) {
      source.deliver({tasks[i].first, results[i]});
      if (tasks[i].first + 1 < tasks[i].end) left.push_back(rest_of(tasks[i], results[i].end));
    }
    tasks = std::move(left);
  }
}

std::vector<SweepTask> TaskBoard::take(std::size_t most) {
  const std::lock_guard<std::mutex> lock(mutex_);
  const auto end = tasks_.begin() + static_cast<std::ptrdiff_t>(std::min(most, tasks_.size()));
  const std::vector<SweepTask> taken(tasks_.begin(), end);
  tasks_.erase(tasks_.begin(), end);
  return taken;
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
