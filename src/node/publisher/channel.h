// One outgoing topic: what is sent goes to its subscribers and to the recorder as the same bytes.
#pragma once

#include <ros/callback_queue_interface.h>
#include <ros/message_traits.h>
#include <ros/node_handle.h>
#include <ros/publication.h>
#include <ros/single_subscriber_publisher.h>
#include <ros/this_node.h>
#include <ros/topic_manager.h>

#include <boost/make_shared.hpp>
#include <cstdint>
#include <deque>
#include <limits>
#include <memory>
#include <mutex>
#include <set>
#include <string>
#include <thread>
#include <utility>

#include "node/recorder/recorder.h"

namespace afm::node {

// The messages of a topic that roscpp still holds for its subscribers. roscpp does not report how full the queue of a
// subscriber is, nor what it drops. But it frees the bytes of a message when the last subscriber has them or lost them.
class Outstanding {
 public:
  // The same message, whose bytes report when they are let go.
  ros::SerializedMessage track(ros::SerializedMessage message) {
    const std::uint64_t number = state_->begin();
    message.buf = boost::shared_array<std::uint8_t>(
        message.buf.get(), [bytes = message.buf, state = state_, number](std::uint8_t*) { state->let_go(number); });
    return message;
  }

  // How many, and the number of the oldest, or that of the next message.
  std::pair<std::size_t, std::uint64_t> held() const {
    const std::lock_guard<std::mutex> lock(state_->mutex);
    return {state_->held.size(), state_->held.empty() ? state_->next : *state_->held.begin()};
  }
  // Messages that a slow subscriber did not get, as its queue here was full.
  std::uint64_t lost() const {
    const std::lock_guard<std::mutex> lock(state_->mutex);
    return state_->lost;
  }
  // Before roscpp lets go of what waited for a subscriber that has left: that is not lost.
  void forgive() {
    const std::lock_guard<std::mutex> lock(state_->mutex);
    state_->forgiven = state_->next;
  }

 private:
  struct State {
    std::uint64_t begin() {
      const std::lock_guard<std::mutex> lock(mutex);
      held.insert(next);
      return next++;
    }
    // Each subscriber gets its messages in order, and the one that is being sent is held: what is let go before an
    // older one was dropped.
    void let_go(std::uint64_t number) {
      const std::lock_guard<std::mutex> lock(mutex);
      if (*held.begin() < number && number >= forgiven) ++lost;
      held.erase(number);
    }
    std::mutex mutex;
    std::set<std::uint64_t> held;
    std::uint64_t next = 0, lost = 0, forgiven = 0;  // forgiven: the messages before that number
  };

  const std::shared_ptr<State> state_ = std::make_shared<State>();
};

// Runs roscpp's callbacks about subscribers at once: over TCP in its thread that sends.
class AtOnce : public ros::CallbackQueueInterface {
  void addCallback(const ros::CallbackInterfacePtr& callback, std::uint64_t) override { callback->call(); }
  void removeByID(std::uint64_t) override {}
};

// The last message of a latched topic, for whoever subscribes. roscpp's own latch takes a message after it has been
// sent: a subscriber that came between the two would have the one before, until the next.
template <class Message>
class Latch {
 public:
  void set_publication(ros::PublicationPtr publication) {
    const std::lock_guard<std::mutex> lock(mutex_);
    publication_ = std::move(publication);
  }

  // Before the message is published.
  void set(const Message& message) {
    const std::lock_guard<std::mutex> lock(mutex_);
    messages_.push_back(message);
    forget_before_last_sent();
  }

  void send_last_to(const ros::SingleSubscriberPublisher& subscriber) {
    const std::lock_guard<std::mutex> lock(mutex_);
    forget_before_last_sent();
    if (sent() > first_) subscriber.publish(messages_.front());
  }

 private:
  // roscpp counts a message when it takes it from its queue for the subscribers that there are. A new one gets those
  // behind it from there.
  std::uint32_t sent() const { return publication_ ? publication_->getSequence() : 0; }
  void forget_before_last_sent() {
    for (; first_ + 1 < sent(); ++first_) messages_.pop_front();
  }

  ros::PublicationPtr publication_;
  std::mutex mutex_;
  std::deque<Message> messages_;
  std::uint32_t first_ = 0;  // its number among all
};

template <class Message>
class Channel {
 public:
  Channel(ros::NodeHandle& node, Recorder& recorder, const char* name, unsigned queue_size, Role role = Role::ordinary)
      : latched_(role == Role::configuration || role == Role::applied || role == Role::snapshot),
        queue_size_(queue_size),
        role_(role),
        publisher_(advertise(node, name, queue_size)),
        bag_topic_(make_bag_topic(node.resolveName(name), latched_)),  // at a shutdown the publisher has no name
        recorder_(recorder) {
    latch_.set_publication(ros::TopicManager::instance()->lookupPublication(bag_topic_->name));
  }

  // for_subscribers: waits until the slowest subscriber has taken up half of its queue, if it takes anything at all.
  // for_recording: waits for room in the recording.
  void send(Message message, bool for_subscribers, bool for_recording) {
    message.header.seq = sequence_++;
    const ros::SerializedMessage bytes = ros::serialization::serializeMessage(message);
    ros::SerializedMessage sent = bytes;
    if (latched_) {
      latch_.set(message);
    } else {
      if (for_subscribers) wait_for_subscribers();
      sent = outstanding_.track(bytes);
    }
    ros::SerializedMessage unused;
    ros::TopicManager::instance()->publish(
        bag_topic_->name, [sent = std::move(sent)] { return sent; }, unused);
    recorder_.record(bag_topic_, bytes, role_, for_recording);
  }

  std::uint64_t lost() const { return outstanding_.lost(); }  // to slow subscribers

 private:
  // roscpp counts by itself and would write over our numbers, unless it does not know of the header: what is on the
  // wire is what is in a bag, to the byte.
  ros::Publisher advertise(ros::NodeHandle& node, const char* name, unsigned queue_size) {
    ros::AdvertiseOptions options;
    options.init<Message>(name, queue_size);
    options.latch = latched_;
    if (latched_) options.connect_cb = [this](const auto& subscriber) { latch_.send_last_to(subscriber); };
    options.disconnect_cb = [this](const auto&) { outstanding_.forgive(); };
    options.callback_queue = &at_once_;
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

  void wait_for_subscribers() {
    constexpr std::chrono::milliseconds kPoll{1};
    constexpr int kPatience = 1000;  // [polls]
    for (int i = 0; i < kPatience; ++i) {
      const auto [count, oldest] = outstanding_.held();
      if (count <= queue_size_ / 2 || oldest == stuck_at_) return;
      std::this_thread::sleep_for(kPoll);
    }
    stuck_at_ = outstanding_.held().second;
  }

  const bool latched_;
  const std::size_t queue_size_;
  const Role role_;
  AtOnce at_once_;
  Latch<Message> latch_;
  Outstanding outstanding_;
  ros::Publisher publisher_;
  const std::shared_ptr<const BagTopic> bag_topic_;
  Recorder& recorder_;
  std::uint32_t sequence_ = 0;
  // the message that a subscriber did not take in a whole wait: until it does, we do not wait for it again
  std::uint64_t stuck_at_ = std::numeric_limits<std::uint64_t>::max();
};

}  // namespace afm::node
