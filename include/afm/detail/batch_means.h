// The standard error of a time average, from the sums over equal consecutive batches of time.
#pragma once

#include <cstddef>
#include <vector>

namespace afm {

// `std_error` is such that mean +- 1.96 std_error holds the true mean 95 times in 100: Student's t for the `degrees` of
// freedom that the estimate of the spread had is already in it.
struct MeanError {
  double std_error;     // of the mean of the batches; NaN below kFewestBatches or for sums that are not finite
  double degrees;       // of freedom, effective
  std::size_t batches;  // used: neighbours are merged until they are no longer correlated
};

constexpr std::size_t kFewestBatches = 16;

// Of a stationary process whose memory is short against the whole. What is left of the correlation of neighbours after
// merging is allowed for: batches of length L err by 1/L, and 2 S(L) - S(L/2) does not (lugsail batch means).
MeanError mean_error(std::vector<double> batches);

// Quantile 0.975 of Student's t over that of the normal distribution, 1.959964; within 2e-3 from 2 degrees on.
double student_widening(double degrees);

}  // namespace afm
