#include "curve_points.h"

namespace afm {

CurvePoints::CurvePoints(const SweepGrid& grid, const CurveSettings& settings, std::size_t first)
    : grid_(grid),
      settings_(settings.sweep),
      method_(settings.method),
      next_chain_(first / grid.chain_length()),
      next_row_(first) {}

void CurvePoints::work() {
  for (std::size_t begin; (begin = next_chain_++ * grid_.chain_length()) < grid_.size();) compute_chain(begin);
}

// Each point of a chain starts where the point before it ended.
void CurvePoints::compute_chain(std::size_t begin) {
  TipState start = random_start(grid_.at(begin), settings_.seed, begin);
  for (std::size_t row = begin; row < begin + grid_.chain_length(); ++row) {
    SweepSettings own = settings_;
    own.bath.stream = row;
    const SweepResult result = method_(grid_.at(row), own, start);
    deliver(row, result);
    start = result.end;
  }
}

void CurvePoints::deliver(std::size_t row, const SweepResult& result) {
  const std::lock_guard<std::mutex> lock(mutex_);
  done_.emplace(row, result);
  delivered_.notify_one();
}

std::vector<SweepResult> CurvePoints::collect(std::chrono::milliseconds patience) {
  const auto is_next_known = [this] { return !done_.empty() && done_.begin()->first == next_row_; };
  std::unique_lock<std::mutex> lock(mutex_);
  delivered_.wait_for(lock, patience, is_next_known);
  std::vector<SweepResult> rows;
  for (; is_next_known(); ++next_row_, done_.erase(done_.begin())) rows.push_back(done_.begin()->second);
  return rows;
}

}  // namespace afm
