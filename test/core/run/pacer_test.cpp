#include "afm/pacer.h"

#include <gtest/gtest.h>

namespace afm {
namespace {

using std::chrono::milliseconds;
using std::chrono::nanoseconds;
using std::chrono::seconds;

constexpr milliseconds kPeriod(10);
constexpr seconds kStart(1000);

// The wall time `ms` after the start.
Pacer::Duration at(int ms) { return kStart + milliseconds(ms); }

TEST(Pacer, DeadlinesAreAbsoluteSoThatLatenessNeverAddsUp) {
  Pacer pacer(kPeriod, kStart);
  for (int batch = 1; batch <= 1000; ++batch) {
    ASSERT_EQ(pacer.deadline(), at(10 * batch));  // the first a period after the start
    pacer.batch_done(at(10 * batch + 3));
  }
  EXPECT_EQ(pacer.batches(), 1000u);
  EXPECT_EQ(pacer.late_batches(), 0u);
  EXPECT_NEAR(pacer.real_time_factor(), 1.0, 1e-9);
  EXPECT_NEAR(pacer.lag(), 0.003, 1e-12);
  EXPECT_NEAR(pacer.worst_lag(), 0.003, 1e-12);
}

TEST(Pacer, ABatchIsLateWhenTheNextOneIsDue) {
  Pacer pacer(kPeriod, kStart);
  pacer.batch_done(at(8));  // early
  EXPECT_EQ(pacer.lag(), 0.0);
  pacer.batch_done(at(30));  // just in time
  EXPECT_EQ(pacer.late_batches(), 0u);
  pacer.batch_done(at(40) + nanoseconds(1));
  EXPECT_EQ(pacer.late_batches(), 1u);
}

TEST(Pacer, WhatWasMissedIsCaughtUpNotForgotten) {
  Pacer pacer(kPeriod, kStart);
  pacer.batch_done(at(10));
  pacer.batch_done(at(520));  // half a second lost
  EXPECT_NEAR(pacer.lag(), 0.5, 1e-12);
  // quick batches follow until model time is up with wall time again
  int batches = 0;
  for (int now = 521; pacer.deadline() <= at(now); ++now, ++batches) pacer.batch_done(at(now));
  EXPECT_EQ(batches, 55);  // 10 periods a batch, 1 ms each: 50 owed and those that came due meanwhile
  EXPECT_LE(pacer.lag(), 0.01);
  EXPECT_NEAR(pacer.worst_lag(), 0.5, 1e-12);
  EXPECT_GT(pacer.late_batches(), 50u);
}

TEST(Pacer, TimeInAPauseIsNotOwed) {
  Pacer pacer(kPeriod, kStart);
  for (int batch = 1; batch <= 150; ++batch) pacer.batch_done(at(10 * batch + 2));
  pacer.resume(at(100000));
  EXPECT_EQ(pacer.lag(), 0.0);
  for (int batch = 1; batch <= 150; ++batch) {
    EXPECT_EQ(pacer.deadline(), at(100000 + 10 * batch));
    pacer.batch_done(at(100002 + 10 * batch));
    EXPECT_NEAR(pacer.real_time_factor(), 1.0, 0.01);
  }
  EXPECT_NEAR(pacer.worst_lag(), 0.002, 1e-12);
  EXPECT_EQ(pacer.late_batches(), 0u);
  EXPECT_EQ(pacer.batches(), 300u);
}

TEST(Pacer, ANewPeriodHoldsAfterTheNextBatch) {
  Pacer pacer(kPeriod, kStart);
  for (int batch = 1; batch <= 50; ++batch) pacer.batch_done(at(10 * batch));
  pacer.set_period(std::chrono::milliseconds(4));
  EXPECT_EQ(pacer.deadline(), at(510));
  for (int batch = 0; batch <= 200; ++batch) pacer.batch_done(at(510 + 4 * batch));
  EXPECT_EQ(pacer.deadline(), at(510 + 4 * 201));
  EXPECT_EQ(pacer.late_batches(), 0u);
  EXPECT_NEAR(pacer.real_time_factor(), 1.0, 0.01);
}

TEST(Pacer, TooSlowByHalfTheRealTimeFactorIsAHalf) {
  Pacer pacer(kPeriod, kStart);
  for (int batch = 1; batch <= 350; ++batch) pacer.batch_done(at(20 * batch));
  EXPECT_NEAR(pacer.real_time_factor(), 0.5, 1e-9);
  // and it recovers
  for (int batch = 1; batch <= 350; ++batch) pacer.batch_done(at(7000 + 10 * batch));
  EXPECT_NEAR(pacer.real_time_factor(), 1.0, 0.02);
}

}  // namespace
}  // namespace afm
