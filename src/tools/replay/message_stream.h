// The messages of one topic, in the order of the bags, with their sequence numbers watched.
#pragma once

#include <rosbag/bag.h>
#include <rosbag/query.h>
#include <rosbag/view.h>

#include <boost/shared_ptr.hpp>
#include <cstdint>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "lengths.h"
#include "verdict.h"

namespace afm::replay {

template <class Message>
class MessageStream {
 public:
  explicit MessageStream(std::string topic) : topic_(std::move(topic)) {}

  void add(const rosbag::Bag& bag, const std::string& path) {
    views_.push_back(std::make_unique<rosbag::View>(bag, rosbag::TopicQuery(topic_)));
    paths_.push_back(path);
    size_ += views_.back()->size();
    if (views_.size() == 1) position_ = views_.front()->begin();
    load();
  }

  const Message* head() const { return head_.get(); }  // null at the end
  boost::shared_ptr<const Message> shared_head() const { return head_; }
  const std::string& path() const { return paths_[view_]; }
  const std::string& topic() const { return topic_; }
  std::uint64_t size() const { return size_; }

  void pop() {
    head_.reset();
    ++position_;
    load();
  }

 private:
  void load() {
    while (!head_ && !views_.empty()) {
      if (position_ != views_[view_]->end()) {
        instantiate();
      } else if (view_ + 1 < views_.size()) {
        position_ = views_[++view_]->begin();
      } else {
        return;
      }
    }
  }

  void instantiate() {
    try {
      bytes_.resize(position_->size());
      ros::serialization::OStream stream(bytes_.data(), static_cast<std::uint32_t>(bytes_.size()));
      position_->write(stream);
      if (!lengths_fit<Message>(bytes_)) throw std::length_error("a list is longer than its message");
      head_ = position_->template instantiate<Message>();
    } catch (const std::exception& error) {
      throw Problem(Verdict::truncated, path() + ": " + topic_ + " cannot be read on: " + error.what());
    }
    if (head_) return;
    throw Problem(Verdict::foreign, path() + ": " + topic_ + " holds messages of type " + position_->getDataType());
  }

  std::string topic_;
  std::vector<std::unique_ptr<rosbag::View>> views_;
  std::vector<std::string> paths_;
  std::size_t view_ = 0;
  std::uint64_t size_ = 0;
  rosbag::View::iterator position_;
  boost::shared_ptr<const Message> head_;
  std::vector<std::uint8_t> bytes_;
};

// Throws Problem if `next` does not follow `last` in its topic. Returns how many messages are missing between them.
inline std::uint64_t follows(std::uint32_t last, std::uint32_t next, const std::string& what) {
  if (next > last) return next - last - 1;
  const std::string numbers = std::to_string(next) + " after " + std::to_string(last);
  throw Problem(Verdict::reordered, what + ": sequence number " + numbers + ": not in the order of publication");
}

}  // namespace afm::replay
