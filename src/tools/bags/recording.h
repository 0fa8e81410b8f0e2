// The messages of one emulator in the bags of one recording, topic by topic: bags by `rosbag record` hold them in the
// order of their arrival, which is that of publishing within a topic alone. Topics are found by type and by the node
// that published them, so their names do not matter.
#pragma once

#include <afm_emulator/Friction.h>
#include <ros/message_traits.h>
#include <rosbag/bag.h>
#include <rosbag/view.h>
#include <std_msgs/Header.h>

#include <algorithm>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "node/recorder/message_bytes.h"

namespace afm::bags {

// Why bags cannot be read or a run cannot be checked.
struct Problem : std::runtime_error {
  using std::runtime_error::runtime_error;
};

// The number of a message in its topic. The numbers begin again when the node is started again.
struct Number {
  std::uint32_t start = 0;  // of the node, counted in the bags
  std::uint32_t seq = 0;    // of the header
};
inline bool operator<(const Number& a, const Number& b) { return std::tie(a.start, a.seq) < std::tie(b.start, b.seq); }
inline bool operator==(const Number& a, const Number& b) { return a.start == b.start && a.seq == b.seq; }

// The messages of one topic, each once: latched ones stand in every bag of a split recording.
template <class Message>
class Cursor {
 public:
  explicit Cursor(std::unique_ptr<rosbag::View> view)
      : view_(std::move(view)), at_(view_->begin()), size_(view_->size()) {
    read();
  }

  // The next message; null at the end.
  const boost::shared_ptr<Message>& get() const { return message_; }
  const Number& number() const { return number_; }
  // Messages lost between the one before and this one.
  std::uint32_t lost() const { return lost_; }
  void next() {
    ++at_;
    read();
  }

  std::size_t read_so_far() const { return done_; }
  std::size_t size() const { return size_; }

 private:
  void read() {
    for (message_.reset(); at_ != view_->end(); ++at_, ++done_) {
      auto message = at_->template instantiate<Message>();
      if (!message) throw Problem(at_->getTopic() + ": a message cannot be read");
      const std_msgs::Header& header = message->header;
      const bool is_twice = last_ && header.seq == number_.seq && header.stamp == last_->header.stamp;
      if (is_twice && is_same(*message, *last_)) continue;
      const bool again = last_ && header.seq <= number_.seq;
      lost_ = last_ && !again ? header.seq - number_.seq - 1 : 0;
      if (is_twice || (lost_ > 0 && number_.start > 0 && header.seq == last_of_start_ + 1)) {
        throw Problem(at_->getTopic() + ": number " + std::to_string(header.seq) +
                      " is of another start of the node than the one before: two starts on simulated time are mixed");
      }
      if (again) last_of_start_ = number_.seq;
      number_ = {number_.start + (again ? 1 : 0), header.seq};
      last_ = message_ = message;
      return;
    }
  }

  // A message of another start may have the same number and, on simulated time, the same stamp.
  static bool is_same(const Message& a, const Message& b) {
    const node::MessageBytes first = node::to_bytes(a), second = node::to_bytes(b);
    return std::equal(first.begin(), first.begin() + first.size(), second.begin(), second.begin() + second.size());
  }

  std::unique_ptr<rosbag::View> view_;
  rosbag::View::iterator at_;
  const std::size_t size_;
  boost::shared_ptr<Message> message_, last_;
  Number number_;
  std::uint32_t last_of_start_ = 0;  // before the present one
  std::uint32_t lost_ = 0;
  std::size_t done_ = 0;
};

class Recording {
 public:
  struct File {
    std::string path;
    std::shared_ptr<rosbag::Bag> bag;
    std::map<std::uint32_t, std::string> nodes;  // by the numbers of their connections
  };
  using Topics = std::map<std::string, std::string>;  // by type

  Recording(std::string node, Topics topics, std::vector<File> files)
      : node_(std::move(node)), topics_(std::move(topics)), files_(std::move(files)) {}

  const std::string& node() const { return node_; }
  std::string name() const;  // of the node and the bags
  const std::vector<File>& files() const { return files_; }
  // Those that follow; so many batches are missing before them.
  void add(const Recording& next, std::uint32_t batches_between);

  template <class Message>
  bool holds() const {
    return topics_.count(ros::message_traits::datatype<Message>()) > 0;
  }
  template <class Message>
  std::string topic() const {
    return holds<Message>() ? topics_.at(ros::message_traits::datatype<Message>()) : "";
  }
  template <class Message>
  std::unique_ptr<Cursor<Message>> read() const {
    return std::make_unique<Cursor<Message>>(view(topic<Message>()));
  }
  std::unique_ptr<rosbag::View> view(const std::string& topic, const ros::Time& begin = ros::TIME_MIN) const;
  using Ends = std::pair<std_msgs::Header, std_msgs::Header>;  // of the first and the last message
  std::optional<Ends> ends_of(const std::string& topic) const;

  struct Missing {
    std::uint32_t at_beginning = 0, at_end = 0;
  };
  // Batches at the ends of the recording of which it should hold a message of this type, but does not.
  template <class Message>
  Missing missing_at_ends() const {
    return missing_at_ends(ros::message_traits::datatype<Message>());
  }

 private:
  Missing missing_at_ends(const std::string& type) const;
  bool is_by_node() const;

  std::string node_;
  Topics topics_;
  std::vector<File> files_;
  std::string holes_;  // between the files, in words
};

// From the bags at these paths: a recording for every emulator, or for the one with this name. Bags that follow each
// other are one recording, also where parts of a split one are missing between them. Throws Problem with the reason if
// there is none.
std::vector<Recording> open_recordings(const std::vector<std::string>& paths, const std::string& node);

// Whether something was applied between two batches, as far as friction tells: another drag velocity, or the estimate
// began again.
inline bool tells_of_command(const afm_emulator::Friction& before, const afm_emulator::Friction& after) {
  return after.drag_velocity != before.drag_velocity || after.impact_count < before.impact_count;
}

}  // namespace afm::bags
