// One outgoing topic: what is sent goes to its subscribers and to the recorder, as one and the same message.
#pragma once

#include <ros/message_traits.h>
#include <ros/node_handle.h>
#include <ros/this_node.h>

#include <boost/make_shared.hpp>
#include <cstdint>
#include <string>
#include <utility>

#include "node/recording/recorder.h"

namespace afm::node {

// How the topic stands in a bag, for readers such as rosbag play.
template <class Message>
BagTopic make_bag_topic(const std::string& resolved_name, bool latched) {
  auto header = boost::make_shared<ros::M_string>();
  (*header)["topic"] = resolved_name;
  (*header)["callerid"] = ros::this_node::getName();
  (*header)["latching"] = latched ? "1" : "0";
  (*header)["type"] = ros::message_traits::datatype<Message>();
  (*header)["md5sum"] = ros::message_traits::md5sum<Message>();
  (*header)["message_definition"] = ros::message_traits::definition<Message>();
  return {resolved_name, header};
}

template <class Message>
class Channel {
 public:
  Channel(ros::NodeHandle& node, Recorder& recorder, const char* name, unsigned queue_size, bool latched = false)
      : publisher_(advertise(node, name, queue_size, latched)),
        bag_topic_(make_bag_topic<Message>(publisher_.getTopic(), latched)),
        recorder_(recorder) {}

  void send(Message&& message) {
    message.header.seq = sequence_++;
    const boost::shared_ptr<const Message> shared = boost::make_shared<const Message>(std::move(message));
    publisher_.publish(shared);
    recorder_.record(bag_topic_, shared);
  }

  void skip() { ++sequence_; }  // a message that nobody wants: its number is not given to another
  std::uint32_t next_sequence() const { return sequence_; }
  bool has_subscribers() const { return publisher_.getNumSubscribers() > 0; }

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

  ros::Publisher publisher_;
  const BagTopic bag_topic_;
  Recorder& recorder_;
  std::uint32_t sequence_ = 0;
};

}  // namespace afm::node
