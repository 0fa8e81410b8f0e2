// What is recorded while nobody keeps time waits for the disk; what is recorded in real time does not.
#include "node/recorder/recorder.h"

#include <gtest/gtest.h>
#include <rosbag/view.h>
#include <std_msgs/String.h>

#include <filesystem>

namespace afm::node {
namespace {

constexpr int kMessages = 400;  // together half more than fits into the queue

class RecorderTest : public testing::Test {
 protected:
  RecorderTest() {
    std_msgs::String message;
    message.data.assign(500'000, 'x');
    bytes_ = to_bytes(message);
    auto header = boost::make_shared<ros::M_string>();
    *header = {{"topic", "/x"},
               {"type", ros::message_traits::datatype<std_msgs::String>()},
               {"md5sum", ros::message_traits::md5sum<std_msgs::String>()},
               {"message_definition", ros::message_traits::definition<std_msgs::String>()}};
    topic_ = std::make_shared<BagTopic>(BagTopic{"/x", header});
  }
  ~RecorderTest() override { std::filesystem::remove_all(directory_); }

  // Records configuration, what is applied and a snapshot, then the messages, faster than any disk.
  Recorder::Status record(bool unhurried) {
    Recorder recorder({directory_, 0, 0, 0.0, rosbag::compression::Uncompressed}, [] {});
    const Recorder::Reply started = recorder.start("run");
    EXPECT_TRUE(started.success) << started.message;
    for (const Role role : {Role::configuration, Role::applied, Role::snapshot}) {
      recorder.record(topic_, bytes_, role, unhurried);
    }
    for (int i = 0; i < kMessages; ++i) recorder.record(topic_, bytes_, Role::ordinary, unhurried);
    EXPECT_TRUE(recorder.stop().success);
    return recorder.status();
  }

  std::size_t messages_in_bag() const {
    rosbag::Bag bag(directory_ + "/run.bag");
    return rosbag::View(bag).size();
  }

  const std::string directory_ = testing::TempDir() + "afm_recorder_" + std::to_string(getpid());
  MessageBytes bytes_;
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

}  // namespace
}  // namespace afm::node
