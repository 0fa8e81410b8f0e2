#include "core/run/batch_means.h"

#include <cmath>

#include "core/not_numbers.h"

namespace afm::detail {
namespace {

struct Spread {
  double variance;     // of one batch
  double correlation;  // of neighbours
};

Spread spread_of(const std::vector<double>& batches) {
  const std::size_t n = batches.size();
  double mean = 0.0, squares = 0.0, products = 0.0;
  for (const double x : batches) mean += x;
  mean /= static_cast<double>(n);
  for (std::size_t i = 0; i < n; ++i) {
    const double d = batches[i] - mean;
    squares += d * d;
    if (i > 0) products += d * (batches[i - 1] - mean);
  }
  // with the mean of the batches, independent ones show a correlation of -1/n
  const double bias = 1.0 / static_cast<double>(n);
  return {squares / static_cast<double>(n - 1), squares > 0.0 ? products / squares + bias : 0.0};
}

std::vector<double> merged(const std::vector<double>& batches) {
  std::vector<double> pairs(batches.size() / 2);
  for (std::size_t i = 0; i < pairs.size(); ++i) pairs[i] = batches[2 * i] + batches[2 * i + 1];
  return pairs;
}

// Beyond two standard deviations of the correlation of independent batches.
bool correlated(const Spread& spread, std::size_t n) {
  return std::abs(spread.correlation) > 2.0 / std::sqrt(static_cast<double>(n));
}

// A choice: the correlation of neighbours reduces the variance at most to this part; less would be chance.
constexpr double kMinVariance = 0.25;

}  // namespace

// Cornish and Fisher's expansion in 1/degrees.
double student_widening(double degrees) {
  constexpr double z = 1.959963984540054, z2 = z * z;
  const double n = degrees;
  const double g1 = (z2 + 1.0) / 4.0;
  const double g2 = ((5.0 * z2 + 16.0) * z2 + 3.0) / 96.0;
  const double g3 = (((3.0 * z2 + 19.0) * z2 + 17.0) * z2 - 15.0) / 384.0;
  const double g4 = ((((79.0 * z2 + 776.0) * z2 + 1482.0) * z2 - 1920.0) * z2 - 945.0) / 92160.0;
  return 1.0 + (g1 + (g2 + (g3 + g4 / n) / n) / n) / n;
}

MeanError mean_error(std::vector<double> batches) {
  double length = 1.0;
  Spread spread = spread_of(batches);
  while (batches.size() >= 2 * kMinBatches && correlated(spread, batches.size())) {
    batches = merged(batches);
    length *= 2.0;
    spread = spread_of(batches);
  }
  if (batches.size() < kMinBatches) return {kNaN, batches.size()};
  const double n = static_cast<double>(batches.size());
  const double degrees = n / 3.0;  // of freedom: 2 over 6/n, the relative variance of variance (1 + 2 correlation)
  const double of_sum = spread.variance * std::fmax(kMinVariance, 1.0 + 2.0 * spread.correlation);
  return {student_widening(degrees) * std::sqrt(of_sum / n) / length, batches.size()};
}

}  // namespace afm::detail
