#include "afm/friction.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>
#include <vector>

namespace afm {
namespace {

Segment impact_at(double t, double energy, std::uint32_t count = 1) {
  Segment impact;
  impact.kind = SegmentKind::impact;
  impact.begin = impact.end = ModelTime{} + t;
  impact.loss = energy;
  impact.count = count;
  return impact;
}

ModelTime time_of(double t) { return ModelTime{} + t; }

Friction started(double window, double eta, double t = 0.0) {
  Friction friction(window);
  friction.restart(time_of(t), eta);
  return friction;
}

TEST(Friction, IsTheEnergyLostOverTheWayDragged) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> energy(0.0, 2.0), pause(0.0, 1.0);
  Friction friction = started(100.0, 2.5, 10.0);
  double t = 10.0;
  long double sum = 0.0L;
  for (int i = 0; i < 100000; ++i) {
    const double dE = energy(random);
    t += pause(random);
    sum += dE;
    friction.add(impact_at(t, dE));
  }
  const FrictionEstimate e = friction.estimate(time_of(t + 0.5), Segment());
  const double power = static_cast<double>(sum / (static_cast<long double>(t) + 0.5L - 10.0L));
  EXPECT_NEAR(e.energy_loss, static_cast<double>(sum), 1e-15 * static_cast<double>(sum));
  EXPECT_NEAR(e.force, power / 2.5, 1e-12);
  EXPECT_NEAR(e.K_f, power / (2.5 * 2.5), 1e-12);
  EXPECT_EQ(e.impact_count, 100000u);
}

TEST(Friction, HasTheSignOfTheDrag) {
  Friction friction = started(8.0, -2.0);
  for (int i = 0; i < 100; ++i) friction.add(impact_at(0.5 + i, i % 4 < 2 ? 0.5 : 1.5));
  const FrictionEstimate e = friction.estimate(time_of(100.0), Segment());
  EXPECT_NEAR(e.force, -0.5, 1e-12);
  EXPECT_NEAR(e.window_force, -0.5, 1e-12);
  EXPECT_NEAR(e.K_f, 0.25, 1e-12);
  EXPECT_GT(e.K_f_std_error, 0.0);
  EXPECT_DOUBLE_EQ(e.force_std_error, 2.0 * e.K_f_std_error);
}

TEST(Friction, ItsErrorsAreThoseOfBinsThatAreIndependent) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> energy(0.0, 2.0);
  Friction friction = started(32.0, 1.0);  // both have bins of a tau
  std::vector<double> energies;
  for (int n = 1; n <= 40; ++n) {
    energies.push_back(energy(random));
    friction.add(impact_at(n - 0.5, energies.back()));
    Friction later = friction;
    later.add(impact_at(n + 0.1, 100.0));  // of a bin that is being filled
    const FrictionEstimate e = later.estimate(time_of(n + 0.2), Segment());
    const auto expected = [&](int last) {
      const std::vector<double> bins(energies.end() - last, energies.end());
      const double mean = std::accumulate(bins.begin(), bins.end(), 0.0) / last;
      double squares = 0.0;
      for (const double bin : bins) squares += (bin - mean) * (bin - mean);
      return std::sqrt(squares / (last - 1) / last);
    };
    const double mean = std::accumulate(energies.begin(), energies.end(), 0.0) / n;
    if (n < 8) continue;
    EXPECT_NEAR(e.K_f_std_error, std::hypot(expected(n), e.K_f - mean), 1e-12) << n;
    EXPECT_NEAR(friction.estimate(time_of(n), Segment()).K_f_std_error, expected(n), 1e-12) << n;
    EXPECT_NEAR(e.window_K_f_std_error, expected(std::min(n, 32)), 1e-12) << n;
  }
}

// Its error was zero, as no bin differed from another.
TEST(Friction, OfAMotionThatRepeatsInEachBinIsWithinItsError) {
  for (const double age : {100.3, 101.7, 103.3}) {
    Friction friction = started(32.0, 1.0);
    for (int i = 0; i + 0.25 < age; ++i) friction.add(impact_at(i + 0.25, 1.0));
    const FrictionEstimate e = friction.estimate(time_of(age), Segment());
    EXPECT_GT(std::abs(e.K_f - 1.0), 1e-3) << age;
    EXPECT_GE(e.K_f_std_error, std::abs(e.K_f - 1.0) - 1e-12) << age;
  }
}

TEST(Friction, OfATipAtRestIsNoughtAndItsCoefficientUndefined) {
  Friction friction = started(10.0, 0.0);
  for (int i = 0; i < 100; ++i) friction.add(impact_at(0.5 + i, 1.0));
  const FrictionEstimate e = friction.estimate(time_of(100.0), Segment());
  EXPECT_EQ(e.force, 0.0);
  EXPECT_EQ(e.window_force, 0.0);
  EXPECT_EQ(e.force_std_error, 0.0);
  EXPECT_TRUE(std::isnan(e.K_f));
  EXPECT_TRUE(std::isnan(e.K_f_std_error));
  EXPECT_TRUE(std::isnan(e.window_K_f));
  EXPECT_EQ(e.energy_loss, 100.0);
}

TEST(Friction, ATipThatTouchesNothingHasNone) {
  Friction friction = started(10.0, 1.0);
  const FrictionEstimate e = friction.estimate(time_of(1e6), Segment());
  EXPECT_EQ(e.force, 0.0);
  EXPECT_EQ(e.K_f, 0.0);
  EXPECT_EQ(e.K_f_std_error, 0.0);
  EXPECT_EQ(e.window_K_f, 0.0);
}

TEST(Friction, SaysNothingBeforeThereIsAnythingToSay) {
  Friction friction = started(64.0, 1.0);
  EXPECT_TRUE(std::isnan(friction.estimate(time_of(0.0), Segment()).K_f));
  friction.add(impact_at(0.5, 1.0));
  const FrictionEstimate e = friction.estimate(time_of(1.5), Segment());
  EXPECT_NEAR(e.K_f, 1.0 / 1.5, 1e-12);
  EXPECT_TRUE(std::isnan(e.K_f_std_error));
  EXPECT_TRUE(std::isnan(e.window_K_f));
}

// Whose error was that of the time with impacts for ever.
TEST(Friction, AfterTheLastImpactItsErrorFallsAsItDoes) {
  Friction friction = started(10.0, 1.0);
  for (int i = 0; i < 100; ++i) friction.add(impact_at(i + 0.5, 1.0));
  const FrictionEstimate e = friction.estimate(time_of(1e5), Segment());
  EXPECT_NEAR(e.K_f, 1e-3, 1e-12);
  EXPECT_GT(e.K_f_std_error, 0.3 * e.K_f);
  EXPECT_LT(e.K_f_std_error, 3.0 * e.K_f);
}

TEST(Friction, ABurstCountsItsBounces) {
  Friction friction = started(10.0, 1.0);
  friction.add(impact_at(1.0, 0.5));
  friction.add(impact_at(2.0, 0.25, 1000));
  EXPECT_EQ(friction.estimate(time_of(3.0), Segment()).impact_count, 1001u);
}

TEST(Friction, TheWindowHoldsItsWindow) {
  Friction friction = started(32.0, 1.0);
  // one impact a tau, of rising energy: the mean over the last 32 bins of one tau each
  for (int i = 0; i < 200; ++i) {
    friction.add(impact_at(i + 0.5, i));
    if (i < 32) continue;
    ASSERT_NEAR(friction.estimate(time_of(i + 1.0), Segment()).window_K_f, i - 15.5, 1e-9) << i;
  }
  // a long silence empties it, whatever the ring held
  EXPECT_NEAR(friction.estimate(time_of(240.0), Segment()).window_K_f, 0.0, 1e-12);
  EXPECT_NEAR(friction.estimate(time_of(1e7), Segment()).window_K_f, 0.0, 1e-12);
}

TEST(Friction, ANewDragVelocityStartsAgain) {
  Friction friction = started(10.0, 1.0);
  for (int i = 0; i < 300; ++i) friction.add(impact_at(i + 0.5, 5.0));
  friction.restart(time_of(300.0), 2.0);
  EXPECT_EQ(friction.estimate(time_of(300.0), Segment()).energy_loss, 0.0);
  EXPECT_EQ(friction.estimate(time_of(300.0), Segment()).impact_count, 0u);
  EXPECT_TRUE(std::isnan(friction.estimate(time_of(300.0), Segment()).K_f));
  for (int i = 300; i < 400; ++i) friction.add(impact_at(i + 0.5, 4.0));
  const FrictionEstimate e = friction.estimate(time_of(400.0), Segment());
  EXPECT_NEAR(e.K_f, 1.0, 1e-12);
  EXPECT_NEAR(e.window_K_f, 1.0, 1e-12);
}

// Energy lost once a tau, each remembering the one before: what a chaotic tip looks like.
struct Measured {
  double mean, std_error, naive_std_error;
};

Measured correlated_run(unsigned seed, int length, double mean) {
  constexpr double kMemory = 0.8;
  std::mt19937_64 random(seed);
  std::normal_distribution<double> noise(0.0, std::sqrt(1.0 - kMemory * kMemory));
  Friction friction = started(100.0, 1.0);
  double x = std::normal_distribution<double>()(random), squares = 0.0;
  for (int i = 0; i < length; ++i) {
    x = kMemory * x + noise(random);
    squares += x * x;
    friction.add(impact_at(i + 0.5, mean + x));
  }
  const FrictionEstimate e = friction.estimate(time_of(length), Segment());
  return {e.K_f, e.K_f_std_error, std::sqrt(squares) / length};
}

TEST(Friction, TheStandardErrorIsThatOfACorrelatedProcess) {
  constexpr int kRuns = 400;
  int covered = 0, covered_naively = 0;
  for (unsigned seed = 0; seed < kRuns; ++seed) {
    const Measured run = correlated_run(seed, 5000, 10.0);
    covered += std::abs(run.mean - 10.0) < 2.0 * run.std_error ? 1 : 0;
    covered_naively += std::abs(run.mean - 10.0) < 2.0 * run.naive_std_error ? 1 : 0;
  }
  // two standard errors hold 95 % of the runs, less a little for the few bins
  EXPECT_GT(covered, kRuns * 90 / 100);
  EXPECT_LT(covered, kRuns * 99 / 100);
  EXPECT_LT(covered_naively, kRuns * 70 / 100) << "the process is not correlated, so this test says nothing";
}

}  // namespace
}  // namespace afm
