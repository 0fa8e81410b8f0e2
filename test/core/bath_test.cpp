#include "afm/bath.h"

#include <gtest/gtest.h>

#include <string>
#include <tuple>
#include <vector>

namespace afm {
namespace {

Model with_ratio(double frequency_ratio) {
  Model model;
  model.frequency_ratio = frequency_ratio;
  return model;
}

Bath with(double quality_factor, double kicks_per_tau = Bath{}.kicks_per_tau) {
  Bath bath;
  bath.quality_factor = quality_factor;
  bath.kicks_per_tau = kicks_per_tau;
  return bath;
}

// K_f was measured at these (docs/levers.md): at half of omega_h/omega_v it is up to 14 % wrong.
TEST(Bath, KicksLockWhereKfWasWrong) {
  EXPECT_TRUE(kicks_lock(with_ratio(14.0), with(20.0, 29.034)));
  for (const double kicks : {11.09, 22.0, 43.5}) EXPECT_TRUE(kicks_lock(with_ratio(22.0), with(100.0, kicks))) << kicks;
  for (const double kicks : {13.597, 29.034, 122.99}) {
    EXPECT_FALSE(kicks_lock(with_ratio(22.0), with(100.0, kicks))) << kicks;
  }
  EXPECT_TRUE(kicks_lock(with_ratio(11.1), with(100.0, 11.09)));
  EXPECT_TRUE(kicks_lock(with_ratio(12.5), with(100.0, 8.652)));
  for (const double kicks : {8.652, 11.09, 46.979, 122.99}) {
    EXPECT_FALSE(kicks_lock(with_ratio(14.0), with(20.0, kicks))) << kicks;
  }
  for (const double kicks : {11.09, 29.034}) EXPECT_FALSE(kicks_lock(Model{}, with(100.0, kicks))) << kicks;
}

// A tip that forgets faster follows the swing within a wider range.
TEST(Bath, ATenthOfATurnFromALockIsTooNearAtALowQualityFactorAlone) {
  for (const double turns : {0.6, 0.9, 1.1, 1.4}) {
    EXPECT_TRUE(kicks_lock(with_ratio(30.0 * turns), with(20.0, 30.0))) << turns;
    EXPECT_FALSE(kicks_lock(with_ratio(30.0 * turns), with(100.0, 30.0))) << turns;
  }
}

TEST(Bath, WithoutKicksOrWithoutALateralSpringNothingLocks) {
  EXPECT_FALSE(kicks_lock(with_ratio(14.0), with(0.0)));
  Model hammer = with_ratio(14.0);
  hammer.kind = ModelKind::hammer;
  EXPECT_FALSE(kicks_lock(hammer, with(20.0)));
}

// At these K_f scattered from start to start by up to fifty times its error (Q = 20, 0 K).
TEST(Bath, KicksLockToTheDragWhereTheyMeetTheSamePhasesOfTheSurface) {
  for (const double cells : {0.5, 1.0, 2.0, -1.0, 1.0003}) {
    EXPECT_TRUE(kicks_lock(Model{}, with(20.0), 29.034 * cells)) << cells;
    const double kicks = suitable_kicks(Model{}, with(20.0), 29.034 * cells);
    EXPECT_FALSE(kicks_lock(Model{}, with(20.0, kicks), 29.034 * cells)) << cells;
    EXPECT_TRUE(find_warnings(Model{}, with(20.0, kicks), 29.034 * cells).empty()) << cells;
  }
  for (const double cells : {0.0, 0.01, 0.2, 0.502, 0.75, 1.002}) {
    EXPECT_FALSE(kicks_lock(Model{}, with(20.0), 29.034 * cells)) << cells;
    EXPECT_EQ(suitable_kicks(Model{}, with(20.0), 29.034 * cells), 29.034) << cells;
  }
  EXPECT_FALSE(kicks_lock(Model{}, with(0.0), 29.034));
  Model hammer;
  hammer.kind = ModelKind::hammer;
  EXPECT_TRUE(kicks_lock(hammer, with(20.0), 29.034));
  ASSERT_EQ(find_warnings(Model{}, with(100.0, 11.09), 11.091).size(), 1u);
  for (const char* word : {"near eta = 11.09,", "give 29.034"}) {
    const std::string reason = find_warnings(Model{}, with(100.0, 11.09), 11.091)[0].reason;
    EXPECT_NE(reason.find(word), std::string::npos) << reason;
  }
  EXPECT_TRUE(find_warnings(Model{}, with(100.0, 11.09)).empty());
  // the golden section itself may lock; 11.09 are too few for these springs
  EXPECT_EQ(suitable_kicks(with_ratio(21.0), with(100.0), 12.979), 29.034);
}

TEST(Bath, TheRateThatAWarningNamesIsWarnedOfByNone) {
  for (const auto& [ratio, Q, eta] : {std::tuple(21.0, 200.0, 6.489), std::tuple(30.0, 300.0, 9.2705)}) {
    const double kicks = suitable_kicks(with_ratio(ratio), with(Q), eta);
    EXPECT_TRUE(find_warnings(with_ratio(ratio), with(Q, kicks), eta).empty()) << ratio;
  }
}

TEST(Bath, SuitableKicksNeverLock) {
  for (double ratio = kMinFrequencyRatio; ratio <= kMaxFrequencyRatio; ratio *= 1.0003) {
    for (const double quality_factor : {kMinQualityFactor, 2.0, 10.0, 20.0, 99.9, 100.0, 1e4}) {
      const double kicks = suitable_kicks(with_ratio(ratio), with(quality_factor));
      ASSERT_FALSE(kicks_lock(with_ratio(ratio), with(quality_factor, kicks))) << ratio << " " << quality_factor;
      ASSERT_TRUE(find_faults(with(quality_factor, kicks)).empty()) << kicks;
      ASSERT_GE(kicks, quality_factor < 100.0 ? 29.034 : 8.6) << ratio;
    }
  }
}

TEST(Bath, SuitableKicksAreThoseThatWereMeasured) {
  const auto suitable = [](double ratio, double quality_factor) {
    return suitable_kicks(with_ratio(ratio), with(quality_factor));
  };
  EXPECT_EQ(suitable(6.25, 100.0), 11.09);
  EXPECT_EQ(suitable(14.0, 100.0), 8.652);
  EXPECT_EQ(suitable(21.0, 100.0), 12.979);
  EXPECT_EQ(suitable(22.0, 100.0), 13.597);
  EXPECT_EQ(suitable(11.1, 100.0), 29.034);  // 11.09 locks
  EXPECT_EQ(suitable(5.5, 100.0), 29.034);   // half a turn
  EXPECT_EQ(suitable(6.25, 20.0), 29.034);
  EXPECT_EQ(suitable(14.0, 20.0), 46.979);
  EXPECT_EQ(suitable(12.5, 20.0), 46.979);  // K_f was 2 to 3 % wrong
  EXPECT_FALSE(kicks_lock(with_ratio(12.5), with(100.0, 29.034)));
}

// K_f by work was up to 39 % too large.
TEST(Bath, InALiquidKicksTakeLittleAtOnce) {
  for (double ratio = kMinFrequencyRatio; ratio <= 34.0; ratio *= 1.01) {
    for (const double quality_factor : {2.0, 5.0, 10.0, 20.0, 100.0}) {
      const Bath bath = with(quality_factor, suitable_kicks(with_ratio(ratio), with(quality_factor)));
      ASSERT_LE(kTwoPi * std::max(1.0, ratio) / (quality_factor * bath.kicks_per_tau), 0.12) << ratio;
      ASSERT_TRUE(find_warnings(with_ratio(ratio), bath).empty()) << ratio << " " << quality_factor;
    }
  }
  EXPECT_FALSE(find_warnings(Model{}, with(2.0)).empty());
  const Bath overdamped = with(0.1);
  EXPECT_FALSE(find_warnings(with_ratio(41.0), with(0.1, suitable_kicks(with_ratio(41.0), overdamped))).empty());
}

TEST(Bath, TheFasterOfTheTwoSpringsSaysHowManyKicksAreNeeded) {
  Bath bath = with(100.0);
  bath.lateral_quality_factor = 20.0;
  EXPECT_EQ(suitable_kicks(Model{}, bath), 29.034);
  bath.quality_factor = 0.0;
  EXPECT_EQ(suitable_kicks(Model{}, bath), 29.034);
}

TEST(Bath, AWarningNamesTheRateAndTheRemedy) {
  EXPECT_TRUE(find_warnings(Model{}, with(20.0)).empty());
  EXPECT_TRUE(find_warnings(with_ratio(14.0), with(100.0, 8.652)).empty());
  EXPECT_TRUE(find_warnings(with_ratio(60.0), with(1e5)).empty());  // K_f as with the golden section of 60
  ASSERT_EQ(find_warnings(with_ratio(14.0), with(20.0, 8.652)).size(),
            1u);  // the rate of a lever's file, with a lower Q
  EXPECT_EQ(find_warnings(with_ratio(14.0), with(20.0, 8.652))[0].reason,
            "is too low for these springs and quality factors: K_f may be wrong by a fifth and more; give 46.979");
  EXPECT_NE(find_warnings(with_ratio(60.0), with(100.0))[0].reason.find("give 37.082"), std::string::npos);
  // the fastest of all
  EXPECT_EQ(find_warnings(with_ratio(22.4), with(0.4))[0].reason,
            "is too low for these springs and quality factors: K_f may be wrong by a fifth and more; give 999.618, "
            "though it is too low as well");
  const std::vector<ParameterError> warnings = find_warnings(with_ratio(14.0), with(20.0));
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_EQ(warnings[0].name, "kicks_per_tau");
  EXPECT_EQ(warnings[0].value, 29.034);
  for (const char* word : {"omega_h/omega_v = 14", "give 46.979"}) {
    EXPECT_NE(warnings[0].reason.find(word), std::string::npos) << warnings[0].reason;
  }
}

}  // namespace
}  // namespace afm
