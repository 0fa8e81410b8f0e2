// Every level of every diagnosis, with its reason, from the state that leads to it.
#include <gtest/gtest.h>

#include "afm/units.h"
#include "node/publisher/status.h"

namespace afm::node {
namespace {

constexpr std::uint8_t kOk = diagnostic_msgs::DiagnosticStatus::OK, kWarn = diagnostic_msgs::DiagnosticStatus::WARN,
                       kError = diagnostic_msgs::DiagnosticStatus::ERROR;

Health healthy() {
  Health health;
  health.lattice_spacing_m = SiModel{}.lattice_spacing_m;
  health.status.scheduler = "normal: not permitted";
  return health;
}

void expect(void (*diagnose)(const Health&, Diagnosis&), const Health& health, std::uint8_t level,
            const std::string& reason) {
  Diagnosis reported;
  diagnose(health, reported);
  EXPECT_EQ(reported.level, level) << reported.message;
  EXPECT_NE(reported.message.find(reason), std::string::npos) << reported.message;
}

TEST(DiagnosePace, TellsLagAndLateBatches) {
  Health health = healthy();
  expect(diagnose_pace, health, kOk, "running");
  health.status.paused = true;
  expect(diagnose_pace, health, kOk, "paused");
  health.late_share = 0.25;
  expect(diagnose_pace, health, kWarn, "25 % of the batches are late (scheduler: normal: not permitted)");
  health.status.lag = 0.7;
  expect(diagnose_pace, health, kWarn, "0.7 s behind");
  health.status.lag = 3.0;
  expect(diagnose_pace, health, kError, "3.0 s behind");
}

TEST(DiagnoseCommands, TellsRefusalsAndSilence) {
  Health health = healthy();
  health.status.refused_commands = 7;  // long ago
  expect(diagnose_commands, health, kOk, "");
  health.timed_out = true;
  health.command_timeout_s = 0.5;
  expect(diagnose_commands, health, kWarn, "no drag velocity for 0.5 s (command_timeout_s)");
  health.refusal = "drag_velocity = nan m/s: must be finite";
  expect(diagnose_commands, health, kWarn, health.refusal);
  health.overload = true;
  expect(diagnose_commands, health, kError, health.refusal);
}

TEST(DiagnoseNumerics, TellsWhatMustStayZero) {
  Health health = healthy();
  health.status.worst_penetration = 1e-14 * health.lattice_spacing_m;  // rounding
  expect(diagnose_numerics, health, kOk, "exact");
  health.budget_spent = true;
  expect(diagnose_numerics, health, kWarn, "impact budget");
  health.status.worst_penetration = 1e-9 * health.lattice_spacing_m;
  expect(diagnose_numerics, health, kError, "below the surface");
  health.status.search_failures = 1;
  expect(diagnose_numerics, health, kError, "have failed");
}

TEST(DiagnoseRecording, TellsOfTheDisk) {
  Health health = healthy();
  expect(diagnose_recording, health, kOk, "not recording");
  health.status.recording = "/bags/run.bag";
  expect(diagnose_recording, health, kOk, "recording");
  health.dropped_from_recording = 1;
  expect(diagnose_recording, health, kError, "missing");
  health.status.recorder_error = "the disk is full";
  expect(diagnose_recording, health, kError, "ended early: the disk is full");
}

class HealthTracking : public testing::Test {
 protected:
  const Health& check(int seconds) {
    tracker_.observe(report_);
    tracker_.check({}, refusals_.summary(), start_ + std::chrono::seconds(seconds));
    return tracker_.health();
  }

  StatusTracker tracker_{Parameters()};
  Report report_;
  RunnerState& runner_ = report_.state;
  Refusals refusals_;
  const StatusTracker::Time start_ = std::chrono::steady_clock::now();
};

TEST_F(HealthTracking, CountsLateBatchesFromCheckToCheck) {
  runner_.batches = 100;
  runner_.late_batches = 50;
  EXPECT_EQ(check(1).late_share, 0.5);
  runner_.batches = 200;
  EXPECT_EQ(check(2).late_share, 0.0);
  EXPECT_EQ(check(3).late_share, 0.0);  // paused
}

TEST_F(HealthTracking, ForgetsWhatIsLongPast) {
  runner_.counters.budget_exhausted = 3;
  EXPECT_TRUE(check(1).budget_spent);
  EXPECT_TRUE(check(10).budget_spent);
  EXPECT_FALSE(check(12).budget_spent);
  runner_.counters.budget_exhausted = 0;  // after a reset
  EXPECT_FALSE(check(13).budget_spent);
  runner_.counters.budget_exhausted = 1;
  EXPECT_TRUE(check(14).budget_spent);
}

TEST_F(HealthTracking, KeepsTheLatestRefusal) {
  refusals_.add(Refusal::faulty_command, "a");
  refusals_.add(Refusal::overload, "b");
  Health health = check(1);
  EXPECT_EQ(health.refusal, "b");
  EXPECT_TRUE(health.overload);
  EXPECT_EQ(refusals_.summary().commands, 2u);
  health = check(60);
  EXPECT_EQ(health.refusal, "");
  EXPECT_FALSE(health.overload);
}

}  // namespace
}  // namespace afm::node
