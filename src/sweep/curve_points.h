// The points of a curve or map, for any number of threads. A result depends on the point and its start alone, so the
// order in which points are computed shows nowhere.
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <map>
#include <mutex>
#include <vector>

#include "grid.h"

namespace afm {

class CurvePoints {
 public:
  // From row `first` on. Precondition: a chain begins there.
  CurvePoints(const SweepGrid& grid, const CurveSettings& settings, std::size_t first = 0);

  void work();  // to be called by each thread; returns when no point is left
  // The next rows in order, as far as they are known without a gap. Waits for one as long as `patience`.
  std::vector<SweepResult> collect(std::chrono::milliseconds patience);

 private:
  void compute_chain(std::size_t begin);
  void deliver(std::size_t row, const SweepResult& result);

  const SweepGrid& grid_;
  const SweepSettings settings_;
  const SweepMethod method_;
  std::atomic<std::size_t> next_chain_;
  std::mutex mutex_;
  std::condition_variable delivered_;
  std::size_t next_row_;                     // the first that was not collected
  std::map<std::size_t, SweepResult> done_;  // from next_row_ on
};

}  // namespace afm
