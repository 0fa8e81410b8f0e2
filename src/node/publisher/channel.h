// One outgoing topic: what is sent goes to its subscribers and to the recorder as the same bytes.
#pragma once

#include <ros/message_traits.h>
#include <ros/node_handle.h>
#include <ros/this_node.h>
#include <ros/topic_manager.h>

#include <boost/make_shared.hpp>
#include <cstdint>
#include <limits>
#include <memory>
#include <string>
#include <thread>
#include <utility>

#include "node/recorder/recorder.h"
#include "outstanding.h"

namespace afm::node {

template <class Message>
class Channel {
 public:
  Channel(ros::NodeHandle& node, Recorder& recorder, const char* name, unsigned queue_size, Role role = Role::ordinary)
      : latched_(role != Role::ordinary),
        queue_size_(queue_size),
        role_(role),
        publisher_(advertise(node, name, queue_size, latched_)),
        bag_topic_(make_bag_topic(publisher_.getTopic(), latched_)),
        recorder_(recorder) {}

  // unhurried: waits until the slowest subscriber has taken up half of its queue, if it takes anything at all.
  void send(Message&& message, bool unhurried = false) {
    message.header.seq = sequence_++;
    const MessageBytes bytes = to_bytes(message);
    if (latched_) {
      publisher_.publish(bytes);
    } else {
      if (unhurried) wait_for_subscribers();
      publish(bytes);
    }
    recorder_.record(bag_topic_, bytes, role_);
  }

  // Messages that a slow subscriber did not get, as its queue here was full. What waited for one that has left is not lost.
  std::uint64_t lost() {
    const std::uint32_t subscribers = publisher_.getNumSubscribers();
    const std::uint64_t lost = outstanding_.take_lost();
    if (subscribers >= std::exchange(subscribers_, subscribers)) lost_ += lost;
    return lost_;
  }

 private:
  // roscpp counts by itself and would write over our numbers, unless it does not know of the header: what is on the wire
  // is what is in a bag, to the byte.
  static ros::Publisher advertise(ros::NodeHandle& node, const char* name, unsigned queue_size, bool latched) {
    ros::AdvertiseOptions options;
    options.init<Message>(name, queue_size);
    options.latch = latched;
    options.has_header = false;
    return node.advertise(options);
  }

  // How the topic stands in a bag, for readers such as rosbag play.
  static std::shared_ptr<const BagTopic> make_bag_topic(const std::string& resolved_name, bool latched) {
    auto header = boost::make_shared<ros::M_string>();
    (*header)["topic"] = resolved_name;
    (*header)["callerid"] = ros::this_node::getName();
    (*header)["latching"] = latched ? "1" : "0";
    (*header)["type"] = ros::message_traits::datatype<Message>();
    (*header)["md5sum"] = ros::message_traits::md5sum<Message>();
    (*header)["message_definition"] = ros::message_traits::definition<Message>();
    return std::make_shared<BagTopic>(BagTopic{resolved_name, header});
  }

  void publish(const MessageBytes& bytes) {
    const ros::SerializedMessage tracked = outstanding_.track(bytes.message);
    ros::SerializedMessage message;
    ros::TopicManager::instance()->publish(bag_topic_->name, [&tracked] { return tracked; }, message);
    lost();
  }

  void wait_for_subscribers() {
    constexpr std::chrono::milliseconds kPoll{1};
    constexpr int kPatience = 1000;  // [polls]
    for (int i = 0; i < kPatience && outstanding_.count() > queue_size_ / 2; ++i) {
      if (outstanding_.oldest() == stuck_at_) return;  // it has taken nothing since we last waited in vain
      std::this_thread::sleep_for(kPoll);
      if (i == kPatience - 1) stuck_at_ = outstanding_.oldest();
    }
  }

  const bool latched_;
  const std::size_t queue_size_;
  const Role role_;
  ros::Publisher publisher_;
  const std::shared_ptr<const BagTopic> bag_topic_;
  Recorder& recorder_;
  std::uint32_t sequence_ = 0;
  std::uint64_t lost_ = 0;
  std::uint32_t subscribers_ = 0;
  Outstanding outstanding_;
  std::uint64_t stuck_at_ = std::numeric_limits<std::uint64_t>::max();  // the message that a subscriber does not take
};

}  // namespace afm::node
