// What is remembered for later recordings stays small however many commands there are, and is enough to go on from.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <thread>

#include "node/wire/checkpoint_message.h"
#include "node/wire/message_conversion.h"
#include "node/recording/run_history.h"
#include "node/stepping/stepper.h"

namespace afm::node {
namespace {

constexpr std::size_t kMostCommands = 2000;  // between checkpoints

// A stepping thread under a flood of commands, and what the publishing side remembers of it: after each event that side
// does something else for a while.
class Flood {
 public:
  explicit Flood(std::chrono::microseconds away = {})
      : away_(away),
        units_(parameters().si),
        hand_over_({1000, 2000000, 400000}),
        stepper_(parameters(), hand_over_, demand_) {
    stepper_.start();
  }

  void send(std::uint64_t commands) {
    const auto give_up = std::chrono::steady_clock::now() + std::chrono::seconds(60);
    for (std::uint64_t sent = 0; applied_ < commands + 1 && std::chrono::steady_clock::now() < give_up;) {
      Request request;
      request.value = 1e-8 * static_cast<double>(sent % 1000);
      while (sent < commands && stepper_.submit(request)) ++sent;
      if (hand_over_.take(event_, batch_, state_)) {
        remember();
        if (away_.count() > 0) std::this_thread::sleep_for(away_);
      } else {
        hand_over_.wait_for(std::chrono::milliseconds(1));
      }
    }
  }

  const RunHistory& history() const { return history_; }
  std::uint64_t applied() const { return applied_; }
  int checkpoints() const { return checkpoints_; }
  std::size_t most_commands() const { return most_commands_; }

 private:
  static Parameters parameters() {
    Parameters p;
    p.checkpoint_interval_s = 3600.0;  // commands alone ask for them
    p.batch_rate_hz = 1000.0;
    p.max_drag_velocity = 1e-4;
    return p;
  }

  template <class Message>
  void remember(const Message& message) {
    history_.remember(boost::make_shared<const Message>(message));
  }
  void remember() {
    const Label label{{}, event_.state.epoch};
    if (event_.kind == Event::Kind::drag_applied) {
      remember(to_applied_drag(event_.state, event_.drag_velocity, event_.level, units_, label));
      ++applied_;
    } else if (event_.kind == Event::Kind::checkpoint) {
      CheckpointContext context;
      context.drags = event_.state.commands;
      remember(to_checkpoint(context, event_.state.time, event_.state.impacts, event_.state.samples, {}, state_));
      ++checkpoints_;
    }
    most_commands_ = std::max(most_commands_, history_.commands().size());
  }

  const std::chrono::microseconds away_;
  const Units units_;
  HandOver hand_over_;
  SampleDemand demand_;
  Stepper stepper_;
  RunHistory history_;
  Event event_;
  Batch batch_;
  SavedState state_;
  std::uint64_t applied_ = 0;
  int checkpoints_ = 0;
  std::size_t most_commands_ = 0;
};

TEST(RunHistory, StaysSmallOverAHundredThousandCommands) {
  constexpr std::uint64_t kCommands = 100000;
  Flood flood;
  flood.send(kCommands);
  ASSERT_EQ(flood.applied(), kCommands + 1);  // and the one an epoch begins with
  EXPECT_GE(flood.checkpoints(), 50);
  // and the one in force at the checkpoint
  EXPECT_LE(flood.most_commands(), kMostCommands + 1);
  const auto& checkpoint = *flood.history().checkpoint();
  EXPECT_EQ(checkpoint.drags + flood.history().commands().size(), flood.applied() + 1);
  const auto emulator = restored(checkpoint);
  ASSERT_TRUE(emulator.has_value());
  EXPECT_EQ(checkpoint.state_digest, digest_of(checkpoint));
}

// Where commands wait for each place that publishing leaves, a checkpoint comes before the next of them.
TEST(RunHistory, StaysSmallWherePublishingIsSlow) {
  constexpr std::uint64_t kCommands = 6000;
  Flood flood(std::chrono::microseconds(400));
  flood.send(kCommands);
  ASSERT_GE(flood.applied(), kCommands / 2);
  EXPECT_GE(flood.checkpoints(), 2);
  EXPECT_LE(flood.most_commands(), kMostCommands + 1);
}

TEST(RunHistory, KeepsWhatIsInForceAtACheckpoint) {
  RunHistory history;
  history.remember(boost::make_shared<const afm_emulator::Configuration>());
  for (std::uint32_t i = 0; i < 10; ++i) {
    afm_emulator::AppliedDrag command;
    command.header.seq = i;
    history.remember(boost::make_shared<const afm_emulator::AppliedDrag>(command));
    afm_emulator::AppliedParameters change;
    change.header.seq = i;
    history.remember(boost::make_shared<const afm_emulator::AppliedParameters>(change));
    if (i == 6) history.remember(boost::make_shared<const afm_emulator::Checkpoint>());
  }
  ASSERT_EQ(history.commands().size(), 4u);
  EXPECT_EQ(history.commands().front()->header.seq, 6u);
  ASSERT_EQ(history.changes().size(), 4u);
  EXPECT_EQ(history.changes().front()->header.seq, 6u);
  history.remember(boost::make_shared<const afm_emulator::Configuration>());  // another epoch
  EXPECT_EQ(history.checkpoint(), nullptr);
  EXPECT_TRUE(history.commands().empty());
  EXPECT_TRUE(history.changes().empty());
}

}  // namespace
}  // namespace afm::node
