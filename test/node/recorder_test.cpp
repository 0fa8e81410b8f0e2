// What the recorder refuses, what it does when its disk fails it, and what waits for the disk: what is recorded while
// nobody keeps time does, what is recorded in real time does not.
#include "node/recorder/recorder.h"

#include <gtest/gtest.h>
#include <rosbag/view.h>
#include <std_msgs/String.h>

#include <atomic>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <future>
#include <thread>

namespace afm::node {
namespace {

namespace fs = std::filesystem;

bool can_be_asked() { return true; }  // for a snapshot

constexpr int kMessages = 400;  // together half more than fits into the queue

class RecorderTest : public testing::Test {
 protected:
  RecorderTest() {
    std_msgs::String message;
    message.data.assign(500'000, 'x');
    bytes_ = ros::serialization::serializeMessage(message);
    auto header = boost::make_shared<ros::M_string>();
    *header = {{"topic", "/x"},
               {"type", ros::message_traits::datatype<std_msgs::String>()},
               {"md5sum", ros::message_traits::md5sum<std_msgs::String>()},
               {"message_definition", ros::message_traits::definition<std_msgs::String>()}};
    topic_ = std::make_shared<BagTopic>(BagTopic{"/x", header});
    fs::create_directories(directory_);
  }
  ~RecorderTest() override { fs::remove_all(directory_); }

  Recorder::Settings settings(std::uint64_t split_bytes = 0, std::uint64_t reserve_bytes = 0) const {
    return {directory_, reserve_bytes, split_bytes, 0.0, rosbag::compression::Uncompressed};
  }
  std::string file(const std::string& name) const { return directory_ + "/" + name; }
  void write_file(const std::string& name) const { std::ofstream(file(name)) << "mine"; }
  bool is_untouched(const std::string& name) const { return fs::file_size(file(name)) == 4; }

  void begin(Recorder& recorder, const std::string& name = "run", bool unhurried = false) {
    const Recorder::Reply started = recorder.start(name);
    EXPECT_TRUE(started.success) << started.message;
    for (const Role role : {Role::configuration, Role::applied, Role::snapshot}) {
      recorder.record(topic_, bytes_, role, unhurried);
    }
  }

  // Records a run of messages, faster than any disk.
  Recorder::Status record(bool unhurried) {
    Recorder recorder(settings(), can_be_asked);
    begin(recorder, "run", unhurried);
    for (int i = 0; i < kMessages; ++i) recorder.record(topic_, bytes_, Role::ordinary, unhurried);
    const Recorder::Reply stopped = recorder.stop();
    EXPECT_TRUE(stopped.success);
    const Recorder::Status status = recorder.status();
    const std::string lost = std::to_string(status.dropped_from_recording) + " more are missing";
    EXPECT_EQ(stopped.message.find(lost) != std::string::npos, status.dropped_from_recording > 0) << stopped.message;
    return status;
  }

  // Goes on recording until the recording ends by itself; returns why.
  std::string record_until_it_ends(Recorder& recorder) {
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(50);
    while (!recorder.status().recording.empty() && std::chrono::steady_clock::now() < deadline) {
      recorder.record(topic_, bytes_, Role::batch_end, true);
    }
    return recorder.status().error;
  }

  std::size_t messages_in_bag(const std::string& name = "run.bag") const {
    return rosbag::View(rosbag::Bag(file(name))).size();
  }

  const std::string directory_ = testing::TempDir() + "afm_recorder_" + std::to_string(getpid());
  ros::SerializedMessage bytes_;
  std::shared_ptr<BagTopic> topic_;
};

TEST_F(RecorderTest, AnUnhurriedMessageWaitsForRoom) {
  EXPECT_EQ(record(true).dropped_from_recording, 0u);
  EXPECT_EQ(messages_in_bag(), kMessages + 3u);
}

TEST_F(RecorderTest, CountsWhatFindsNoRoom) {
  const std::uint64_t dropped = record(false).dropped_from_recording;
  EXPECT_GT(dropped, 0u);
  EXPECT_EQ(messages_in_bag() + dropped, kMessages + 3u);
}

TEST_F(RecorderTest, RefusesNamesThatLeadElsewhereAndThoseThatAreTaken) {
  write_file("kept.bag");
  Recorder recorder(settings(), can_be_asked);
  for (const char* name : {"/tmp/away.bag", "../away.bag", "sub/away.bag", "..", ".", "sub/", "kept.bag"}) {
    const Recorder::Reply reply = recorder.start(name);
    EXPECT_FALSE(reply.success) << name;
    EXPECT_FALSE(reply.message.empty()) << name;
  }
  EXPECT_TRUE(is_untouched("kept.bag"));
  const Recorder::Reply by_itself = recorder.start("");
  EXPECT_TRUE(by_itself.success) << by_itself.message;
  EXPECT_EQ(fs::path(by_itself.path).parent_path(), fs::absolute(directory_).lexically_normal());
}

TEST_F(RecorderTest, MakesOneRecordingAtATime) {
  Recorder recorder(settings(), can_be_asked);
  EXPECT_FALSE(recorder.stop().success);
  EXPECT_TRUE(recorder.start("run").success);
  EXPECT_FALSE(recorder.start("second").success);
  EXPECT_TRUE(recorder.stop().success);
  EXPECT_FALSE(recorder.stop().success);
}

// Of two clients: a stop used to wait for the recording that began as the one before was closed.
TEST_F(RecorderTest, AStopEndsTheRecordingThatItFinds) {
  Recorder recorder(settings(), can_be_asked);
  std::atomic<bool> done{false};
  std::thread other([&] {
    for (int i = 0; !done; ++i) recorder.start("run_" + std::to_string(i));
  });
  for (int stopped = 0; stopped < 500;) {
    const Recorder::Reply reply = recorder.stop();
    stopped += reply.success;
    if (reply.message.find("slow disk") != std::string::npos) {
      ADD_FAILURE() << reply.message;
      break;
    }
  }
  done = true;
  other.join();
}

TEST_F(RecorderTest, DoesNotStartWhereItCannotWrite) {
  for (const char* directory : {"/sys/kernel", "/dev/null/bags"}) {  // where not even root can make a file
    Recorder::Settings elsewhere = settings();
    elsewhere.directory = directory;
    const Recorder::Reply reply = Recorder(elsewhere, can_be_asked).start("run");
    EXPECT_FALSE(reply.success);
    EXPECT_NE(reply.message.find(directory), std::string::npos) << reply.message;
  }
}

TEST_F(RecorderTest, DoesNotStartWithoutRoom) {
  const Recorder::Reply reply = Recorder(settings(0, std::uint64_t{1} << 60), can_be_asked).start("run");
  EXPECT_FALSE(reply.success);
  EXPECT_NE(reply.message.find("disk_reserve_mb"), std::string::npos) << reply.message;
  EXPECT_TRUE(fs::is_empty(directory_));
}

TEST_F(RecorderTest, EndsWhereItsBagIsTakenAwayAndCanBeginAgain) {
  Recorder recorder(settings(), can_be_asked);
  begin(recorder);
  fs::remove_all(directory_);
  EXPECT_NE(record_until_it_ends(recorder).find("No such file"), std::string::npos);
  EXPECT_FALSE(recorder.stop().success);
  begin(recorder, "again");
  EXPECT_TRUE(recorder.stop().success);
  EXPECT_TRUE(fs::exists(file("again.bag")));
}

// Its last batch had samples and impacts, but not where it ended.
TEST_F(RecorderTest, AStopWaitsForTheEndOfABatch) {
  Recorder recorder(settings(), can_be_asked);
  begin(recorder);
  recorder.record(topic_, bytes_, Role::batch, false);
  std::promise<void> begun;
  std::future<Recorder::Reply> stop = std::async(std::launch::async, [&] {
    begun.set_value();
    return recorder.stop();
  });
  begun.get_future().wait();
  EXPECT_EQ(stop.wait_for(std::chrono::milliseconds(100)), std::future_status::timeout);
  recorder.record(topic_, bytes_, Role::batch_end, false);
  EXPECT_TRUE(stop.get().success);
  EXPECT_EQ(messages_in_bag("run.bag"), 5u);
}

// Every bag is full at the end of its first batch.
class SplitRecordingTest : public RecorderTest {
 protected:
  void record(Role role, int times = 1) {
    for (int i = 0; i < times; ++i) recorder_.record(topic_, bytes_, role, true);
  }
  // For a snapshot, so often.
  bool is_asked(int times) const {
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(50);
    while (asked_ < times && std::chrono::steady_clock::now() < deadline) std::this_thread::yield();
    return asked_ >= times;
  }

  std::atomic<int> asked_{0}, refusals_{0};
  Recorder recorder_{settings(1), [this] { return ++asked_ > refusals_; }};
};

// One that is stopped within the first batch after a split has no bag that begins there; nothing of it is lost.
TEST_F(SplitRecordingTest, EveryBagHasAWholeBatch) {
  for (const bool whole : {false, true}) {
    const std::string name = whole ? "whole" : "part";
    begin(recorder_, name);
    record(Role::batch_end);  // before that no other bag is asked for
    ASSERT_TRUE(is_asked(whole ? 2 : 1));
    record(Role::snapshot);
    record(Role::ordinary);
    if (whole) record(Role::batch_end);
    EXPECT_TRUE(recorder_.stop().success);
    EXPECT_EQ(messages_in_bag(name + ".bag"), whole ? 4u : 6u);
    ASSERT_EQ(fs::exists(file(name + "_001.bag")), whole);
    if (whole) {
      EXPECT_EQ(messages_in_bag(name + "_001.bag"), 5u);
    }
  }
}

// As in a pause, in which only the status is published.
TEST_F(SplitRecordingTest, WhatNoBatchFollowsIsWrittenAndAnotherSnapshotAskedFor) {
  begin(recorder_);
  record(Role::batch_end);
  ASSERT_TRUE(is_asked(1));
  record(Role::snapshot);
  record(Role::ordinary, 120);
  ASSERT_TRUE(is_asked(2));
  record(Role::snapshot);
  record(Role::batch_end);
  EXPECT_EQ(recorder_.stop().message, file("run_001.bag") + ": the last of 2 bags with 129 messages");
  EXPECT_EQ(messages_in_bag(), 125u);
  EXPECT_EQ(messages_in_bag("run_001.bag"), 4u);
}

// More commands than messages that it waits for kept a recording from splitting.
TEST_F(SplitRecordingTest, ManyCommandsWithinABatchAreNoPause) {
  begin(recorder_);
  record(Role::batch_end);
  ASSERT_TRUE(is_asked(1));
  record(Role::snapshot);
  record(Role::applied, 300);
  record(Role::batch_end);
  EXPECT_TRUE(recorder_.stop().success);
  EXPECT_EQ(messages_in_bag(), 4u);
  EXPECT_EQ(messages_in_bag("run_001.bag"), 304u);
}

// A reset may come before the snapshot that was asked for. The bag before held the beginning of an epoch without its
// snapshot, and bag_check called it not sound.
TEST_F(SplitRecordingTest, AnEpochBeginsInOneBag) {
  begin(recorder_);
  record(Role::batch_end);
  ASSERT_TRUE(is_asked(1));
  for (const Role role : {Role::configuration, Role::applied, Role::snapshot}) record(role);
  record(Role::batch_end);
  EXPECT_TRUE(recorder_.stop().success);
  EXPECT_EQ(messages_in_bag(), 4u);
  EXPECT_EQ(messages_in_bag("run_001.bag"), 4u);
}

TEST_F(SplitRecordingTest, AsksAgainForASnapshotThatCouldNotBeAskedFor) {
  refusals_ = 2;
  begin(recorder_);
  record(Role::batch_end, 3);  // it asks once at each
  EXPECT_TRUE(is_asked(3));
}

TEST_F(RecorderTest, LeavesNoBagWhereNothingCame) {
  Recorder recorder(settings(), can_be_asked);
  EXPECT_TRUE(recorder.start("run").success);
  EXPECT_TRUE(recorder.stop().success);
  EXPECT_TRUE(fs::is_empty(directory_));
  EXPECT_TRUE(recorder.start("run").success);
}

TEST_F(RecorderTest, DoesNotStartWhereOnlyItsFirstPartFindsRoom) {
  write_file("run_002.bag");
  write_file("killed_001.bag.active");
  Recorder splitting(settings(5'000'000), can_be_asked), whole(settings(), can_be_asked);
  EXPECT_NE(splitting.start("run").message.find("run_002.bag"), std::string::npos);
  EXPECT_NE(splitting.start("killed").message.find("killed_001.bag.active"), std::string::npos);
  EXPECT_TRUE(splitting.start("other").success);
  EXPECT_TRUE(whole.start("run").success);
  EXPECT_TRUE(is_untouched("run_002.bag"));
}

TEST_F(RecorderTest, EndsWhereTheNameOfItsNextPartIsTaken) {
  Recorder* self = nullptr;
  Recorder recorder(settings(5'000'000), [&] {
    self->record(topic_, bytes_, Role::snapshot, false);
    return true;
  });
  self = &recorder;
  begin(recorder);
  write_file("run_001.bag");
  EXPECT_NE(record_until_it_ends(recorder).find("run_001.bag"), std::string::npos);
  EXPECT_TRUE(is_untouched("run_001.bag"));
  EXPECT_GT(messages_in_bag(), 3u);
}

}  // namespace
}  // namespace afm::node
