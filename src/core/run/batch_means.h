// The standard error of a time average from the sums over equal consecutive batches of time (method of batch means).
#pragma once

#include <cmath>
#include <cstddef>
#include <vector>

namespace afm::detail {

// mean +- 1.96 std_error holds the true mean 95 times in 100: std_error includes the factor of Student's t.
struct MeanError {
  double std_error;     // of the mean of the batches; NaN with fewer than kMinBatches or sums that are not finite
  std::size_t batches;  // used, after neighbours were merged until they are uncorrelated
};

// Batches of a time average: four times the least number, so that neighbours can merge twice.
constexpr std::size_t kTimeBatches = 64;
constexpr std::size_t kMinBatches = 16;  // a choice: Student's t of 16/3 degrees widens the error by 1.29

// Precondition: a stationary process whose memory is short against the whole. Batches of length L leave an error of
// order 1/L from the correlation of neighbours; 2 S(L) - S(L/2) removes it (lugsail batch means).
MeanError mean_error(std::vector<double> batches);

// The work of the drag also holds the energy that the tip has stored since the start. It is known, as a part of the
// estimate: the work beyond what was lost in impacts and given to a bath. The scatter of batches that end where the
// surface repeats does not show it.
inline double work_std_error(double std_error, double stored) {
  return std::sqrt(std_error * std_error + stored * stored);
}

// Quantile 0.975 of Student's t over that of the normal distribution, 1.959964; within 2e-3 from 2 degrees on.
double student_widening(double degrees);

}  // namespace afm::detail
