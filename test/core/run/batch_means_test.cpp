#include "core/run/batch_means.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace afm {

using namespace detail;

namespace {

TEST(BatchMeans, TheWideningIsStudents) {
  constexpr double kNormal = 1.959963984540054;
  const double table[][2] = {
      {3, 3.182446305}, {5, 2.570581836}, {10, 2.228138852}, {20, 2.085963447}, {60, 2.000297822}};
  for (const auto& row : table) EXPECT_NEAR(student_widening(row[0]) * kNormal, row[1], 5e-3 * row[1]) << row[0];
  EXPECT_NEAR(student_widening(5.0) * kNormal, 2.570581836, 1e-3);
  EXPECT_NEAR(student_widening(20.0) * kNormal, 2.085963447, 1e-6);
}

// Batches that remember the one before; their stationary mean is 0.
std::vector<double> correlated(std::mt19937_64& random, std::size_t n, double memory) {
  std::normal_distribution<double> noise(0.0, 1.0);
  std::vector<double> batches(n);
  double x = noise(random) / std::sqrt(1.0 - memory * memory);
  for (double& batch : batches) batch = x = memory * x + noise(random);
  return batches;
}

double coverage(double memory, std::size_t n) {
  constexpr int kRuns = 4000;
  std::mt19937_64 random(1);
  int covered = 0;
  for (int run = 0; run < kRuns; ++run) {
    const std::vector<double> batches = correlated(random, n, memory);
    double sum = 0.0;
    for (const double x : batches) sum += x;
    covered += std::abs(sum / static_cast<double>(n)) < 1.96 * mean_error(batches).std_error ? 1 : 0;
  }
  return static_cast<double>(covered) / kRuns;
}

TEST(BatchMeans, NineteenInTwentyIntervalsHoldTheMean) {
  EXPECT_NEAR(coverage(0.0, 64), 0.95, 0.02);
  EXPECT_NEAR(coverage(0.2, 64), 0.95, 0.02);
  EXPECT_NEAR(coverage(-0.2, 64), 0.95, 0.02);
  EXPECT_NEAR(coverage(0.5, 512), 0.95, 0.02);
  EXPECT_NEAR(coverage(0.0, 16), 0.95, 0.01);
}

TEST(BatchMeans, TheVarianceOfTheMeanIsRightOnAverage) {
  constexpr int kRuns = 4000;
  constexpr double kBatches = 16.0;
  std::mt19937_64 random(1);
  double squares = 0.0;
  for (int run = 0; run < kRuns; ++run) {
    const double error = mean_error(correlated(random, 16, 0.0)).std_error / student_widening(kBatches / 3.0);
    squares += error * error;
  }
  EXPECT_NEAR(squares / kRuns * kBatches, 1.0, 0.03);
}

TEST(BatchMeans, MergesWhatIsCorrelated) {
  std::mt19937_64 random(1);
  EXPECT_GE(mean_error(correlated(random, 1024, 0.0)).batches, 256u);
  EXPECT_LE(mean_error(correlated(random, 1024, 0.95)).batches, 128u);
}

TEST(BatchMeans, SaysNothingOfTooFew) {
  EXPECT_TRUE(std::isnan(mean_error(std::vector<double>(kMinBatches - 1, 1.0)).std_error));
  EXPECT_EQ(mean_error(std::vector<double>(kMinBatches, 1.0)).std_error, 0.0);
}

}  // namespace
}  // namespace afm
