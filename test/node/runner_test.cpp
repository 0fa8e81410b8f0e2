// What the running thread reports, and when it goes on, without a node around it.
#include "node/runner/runner.h"

#include <gtest/gtest.h>

#include <chrono>
#include <thread>

namespace afm::node {
namespace {

// A running thread whose reports are taken one by one.
class RunnerTest : public testing::Test {
 protected:
  explicit RunnerTest(const Parameters& p = waiting()) : queue_(16, preallocated_batch(p)), runner_(p, queue_) {
    runner_.start();
  }

  static Parameters waiting() {
    Parameters p;
    p.model = "hammer";
    p.pace = kLockstep;
    p.wait_for = kCommand;
    p.command_wait_s = 0.3;
    return p;
  }

  bool take() {
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(20);
    while (!queue_.take(report_) && std::chrono::steady_clock::now() < deadline) std::this_thread::yield();
    return std::chrono::steady_clock::now() < deadline;
  }

  BatchQueue queue_;
  Runner runner_;
  Report report_;
};

TEST_F(RunnerTest, EveryReportNamesTheLevelThatRuns) {
  do {
    ASSERT_TRUE(take());
    EXPECT_EQ(report_.in_force.level.kind, ModelKind::hammer);
  } while (report_.kind != Report::Kind::batch);
}

// Its publisher may be held up by somebody slow: who has not seen a batch cannot answer it.
TEST_F(RunnerTest, ACommandIsWaitedForFromWhenTheBatchIsPublished) {
  do {
    ASSERT_TRUE(take());
  } while (report_.kind != Report::Kind::batch);
  std::this_thread::sleep_for(std::chrono::milliseconds(400));  // longer than a command is waited for
  Report early;
  EXPECT_FALSE(queue_.take(early));
  const auto published = std::chrono::steady_clock::now();
  queue_.release(report_.batch);
  EXPECT_TRUE(take());
  EXPECT_GE(std::chrono::steady_clock::now() - published, std::chrono::milliseconds(300));
}

}  // namespace
}  // namespace afm::node
