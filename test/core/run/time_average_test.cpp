#include "afm/time_average.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <cstdio>

#include "afm/sweep.h"
#include "support/models.h"

namespace afm {
namespace {

// How many of the 95 % intervals of short runs hold the mean of a run of 1e7 tau, by both estimators.
struct Chaotic {
  double eta, K_f;  // v_c = 0.1 eta
};

class Coverage : public testing::TestWithParam<Chaotic> {};

TEST_P(Coverage, IsNineteenInTwenty) {
  constexpr int kSeeds = 3000;
  const Chaotic& known = GetParam();
  const SweepPoint point{known.eta, 0.7, 0.1 * known.eta};
  int covered = 0, covered_by_work = 0;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    Tip tip(model_of(point), point.eta, random_start(point, seed, 0));
    average_over_time(tip, 100.0);
    const FrictionAverage average = average_over_time(tip, 1000.0);
    covered += std::abs(average.K_f - known.K_f) < 1.96 * average.K_f_std_error ? 1 : 0;
    covered_by_work += std::abs(average.K_f_work - known.K_f) < 1.96 * average.K_f_work_std_error ? 1 : 0;
  }
  std::printf("eta = %g: %.1f %% and %.1f %%\n", known.eta, 100.0 * covered / kSeeds, 100.0 * covered_by_work / kSeeds);
  EXPECT_GE(covered, kSeeds * 93 / 100);
  EXPECT_LE(covered, kSeeds * 97 / 100);
  EXPECT_GE(covered_by_work, kSeeds * 93 / 100);
  EXPECT_LE(covered_by_work, kSeeds * 97 / 100);
}

INSTANTIATE_TEST_SUITE_P(Chaos, Coverage,
                         testing::Values(Chaotic{2.75, 0.28925}, Chaotic{3.4, 0.25305}, Chaotic{5.0, 0.18813}));

// The energy stored at the ends of the batches is many times the work between them.
TEST(AverageOverTime, ASlowDragHasItsFrictionByTheWorkToo) {
  const SweepPoint point{0.02, 0.7, 0.05};
  SweepSettings settings;
  settings.duration = 1000.0;
  settings.transient = 200.0;
  const FrictionAverage a = sweep_point(point, settings, to_tip_state(Model{}.H, start_at(point.eta))).friction;
  EXPECT_NEAR(a.K_f_work, 0.019, 3.0 * a.K_f_work_std_error);
  EXPECT_LT(a.K_f_work_std_error, 0.005);
}

// The first contact begins before the interval, and its end is the first event.
TEST(AverageOverTime, TheTipFliesWheneverItIsNotInContact) {
  constexpr double kDuration = 100.0;
  Tip tip(model_with_cutoff(0.01), 0.3, start_at(0.3));
  while (tip.advance(kEndOfTime) != Outcome::contact) continue;
  Tip watched = tip;
  const ModelTime end = tip.now() + kDuration;
  double contact = 0.0;
  Segments ended;
  while (watched.advance_segment(end, &ended) != Outcome::time_limit) {
    for (const Segment& s : ended) contact += s.kind == SegmentKind::contact ? s.end - s.begin : 0.0;
  }
  if (watched.in_contact()) contact += end - watched.segment().begin;
  const FrictionAverage a = average_over_time(tip, kDuration);
  EXPECT_GT(contact, 1.0);
  EXPECT_NEAR(a.mean_flight_time * a.impacts_per_tau * kDuration, kDuration - contact, 1e-9);
}

// From a start that is not on the orbit yet.
TEST(AverageOverPeriods, TheErrorsAreTheDifferencesFromTheFirstHalf) {
  constexpr double kEta = 2.0, kHalf = 2.0;
  Tip tip(model_with_cutoff(0.2), kEta, start_at(kEta)), again = tip;
  const FrictionAverage second = average_over_periods(tip, 1, 2.0 * kHalf);
  while (again.advance(tip.now() + -2.0 * kHalf) != Outcome::time_limit) continue;
  const FrictionAverage first = average_over_time(again, kHalf);
  const double change = std::abs(second.K_f - first.K_f), work_change = std::abs(second.K_f_work - first.K_f_work);
  EXPECT_GT(std::abs(work_change - change), 1e-3);
  EXPECT_NEAR(second.K_f_std_error, change, 1e-12);
  EXPECT_NEAR(second.K_f_work_std_error, work_change, 1e-12);
}

TEST(SweepPoint, EndsWhereItsTipIs) {
  const SweepPoint point{3.4, 0.7, 0.05};
  SweepSettings settings;
  settings.duration = 16.0;
  settings.transient = 4.0;
  const TipState start = random_start(point, 1, 0);
  Tip tip(model_of(point), point.eta, start);
  while (tip.advance({20, 0.0}) != Outcome::time_limit) continue;
  const TipState end = sweep_point(point, settings, start).end, expected = tip.tip_state();
  EXPECT_EQ(end.phase, expected.phase);
  EXPECT_EQ(end.X, expected.X);
  EXPECT_EQ(end.g1, expected.g1);
}

}  // namespace
}  // namespace afm
