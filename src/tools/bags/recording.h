// The messages of one emulator in the bags of one recording, topic by topic: bags by `rosbag record` hold them in the
// order of their arrival, which is that of publishing within a topic alone. Topics are found by type and by the node
// that published them, so their names do not matter.
#pragma once

#include <afm_emulator/Friction.h>
#include <ros/message_traits.h>
#include <ros/serialization.h>
#include <rosbag/bag.h>
#include <rosbag/view.h>
#include <std_msgs/Header.h>

#include <algorithm>
#include <cstdint>
#include <deque>
#include <exception>
#include <map>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

namespace afm::bags {

// Why bags cannot be read or a run cannot be checked.
struct Problem : std::runtime_error {
  using std::runtime_error::runtime_error;
};

inline bool same_bytes(const ros::SerializedMessage& a, const ros::SerializedMessage& b) {
  return std::equal(a.buf.get(), a.buf.get() + a.num_bytes, b.buf.get(), b.buf.get() + b.num_bytes);
}

// The number of a message in its topic. The numbers begin again when the node is started again.
struct Number {
  std::uint64_t start = 0;  // of the node: when it was [ns]; 0: the first one, or on simulated time
  std::uint32_t seq = 0;    // of the header
};
inline bool operator<(const Number& a, const Number& b) { return std::tie(a.start, a.seq) < std::tie(b.start, b.seq); }
inline bool operator==(const Number& a, const Number& b) { return a.start == b.start && a.seq == b.seq; }

// When the node was started. On wall time a stamp shows after which start a message was made, even if others are
// missing.
class Starts {
 public:
  // A start was after the stamp `behind`, and not after the stamp `latest`.
  void add(const ros::Time& behind, const ros::Time& latest) { found_.push_back({latest, behind}); }
  // The wall clock was set back to before a start, as a message shows that was recorded before it was made.
  void set_back() { is_set_back_ = true; }
  void merge() {
    std::sort(found_.begin(), found_.end());
    for (const auto& [latest, behind] : found_) {
      if (times_.empty() || times_.back() <= behind) times_.push_back(latest);
    }
    const bool is_first = times_.size() == 1 && found_.front().second == ros::TIME_MIN;
    if (is_set_back_ && is_first) times_.clear();  // stamps before it are of this start too
  }
  bool are_several() const { return times_.size() > 1; }
  // The last start that is not later than the stamp [ns]; 0 if there is none.
  std::uint64_t of(const ros::Time& stamp) const {
    const auto later = std::upper_bound(times_.begin(), times_.end(), stamp);
    return later == times_.begin() ? 0 : (later - 1)->toNSec();
  }
  std::uint32_t between(std::uint64_t one, std::uint64_t other) const {
    const auto is_between = [&](const ros::Time& time) { return one < time.toNSec() && time.toNSec() < other; };
    return static_cast<std::uint32_t>(std::count_if(times_.begin(), times_.end(), is_between));
  }

 private:
  std::vector<std::pair<ros::Time, ros::Time>> found_;
  std::vector<ros::Time> times_;
  bool is_set_back_ = false;
};

// Simulated time begins at 1 s, and wall clocks have passed 1e9 s in 2001.
inline bool is_simulated(const ros::Time& stamp) { return stamp < ros::Time(1000000000, 0); }

// The messages of one topic, each once: latched ones stand in every bag of a split recording, in those by rosbag record
// the first one that it has heard.
template <class Message>
class Cursor {
 public:
  // fault: of all cursors of these bags.
  Cursor(std::unique_ptr<rosbag::View> view, std::shared_ptr<const Starts> starts,
         std::shared_ptr<std::exception_ptr> fault)
      : view_(std::move(view)),
        at_(view_->begin()),
        size_(view_->size()),
        starts_(std::move(starts)),
        fault_(std::move(fault)) {
    if (at_ != view_->end()) topic_ = at_->getTopic();
    read();
  }

  // Whether it is a latched message that rosbag record repeats, without the name of its node.
  bool is_repeated() const { return ahead_.front().is_repeated; }
  // The next message; null at the end.
  const boost::shared_ptr<Message>& get() const { return message_; }
  const Number& number() const { return number_; }
  // Messages lost between the one before and this one; one for each start of the node of which all are lost.
  std::uint32_t lost() const { return lost_; }
  void next() {
    ahead_.pop_front();
    ++done_;
    read();
  }

  std::size_t read_so_far() const { return done_; }
  std::size_t size() const { return size_; }

 private:
  struct Held {
    boost::shared_ptr<Message> message;
    bool is_repeated;
  };

  // Some messages at once: rosbag unpacks a whole chunk for each that is not in the same one as the last, and others
  // read other topics of the bag. What cannot be read is a fault when its turn comes, and nobody reads on: rosbag has
  // then unpacked half a chunk into the memory of another one.
  bool read_ahead() {
    constexpr std::size_t kBytes = 1000000;  // a choice: more than a chunk of 0.8 MB
    for (std::size_t bytes = 0; !*fault_ && (ahead_.empty() || bytes < kBytes);) {
      try {
        if (at_ == view_->end()) break;
        auto message = at_->template instantiate<Message>();
        if (!message) throw Problem(topic_ + ": a message cannot be read");
        bytes += ros::serialization::serializationLength(*message);
        ahead_.push_back({message, at_->getCallerId().empty()});
        ++at_;
      } catch (...) {
        *fault_ = std::current_exception();
      }
    }
    if (ahead_.empty() && *fault_ && at_ != view_->end()) std::rethrow_exception(*fault_);
    return !ahead_.empty();
  }

  void read() {
    for (message_.reset(); !ahead_.empty() || read_ahead(); ahead_.pop_front(), ++done_) {
      const boost::shared_ptr<Message> message = ahead_.front().message;
      const std_msgs::Header& header = message->header;
      if (is_same(*message, last_.get()) || is_same(*message, first_.get())) continue;
      find_number(header);
      if (!first_) first_ = message;
      last_ = message_ = message;
      return;
    }
  }

  void find_number(const std_msgs::Header& header) {
    Number next{starts_->of(header.stamp), header.seq};
    if (last_) {
      // a start of which nothing else is left
      const bool again = header.seq <= number_.seq && header.stamp > last_->header.stamp && !is_simulated(header.stamp);
      next.start = std::max(next.start, again && next.start <= number_.start ? header.stamp.toNSec() : number_.start);
      if (!(number_ < next)) {
        throw Problem(topic_ + ": number " + std::to_string(header.seq) + " comes behind number " +
                      std::to_string(number_.seq) + ": it is there twice, or the messages are out of order, or of " +
                      "another start of the node on simulated time");
      }
      if (next.start != number_.start && header.seq == number_.seq + 1) {
        throw Problem(topic_ + ": number " + std::to_string(header.seq) +
                      " is of a start that was still running when another node took its name");
      }
    }
    const bool same = !last_ || next.start == number_.start;
    lost_ = !last_ ? 0 : same ? header.seq - number_.seq - 1 : starts_->between(number_.start, next.start);
    number_ = next;
  }

  // A message of another start may have the same number and, on simulated time, the same stamp.
  static bool is_same(const Message& a, const Message* b) {
    return b != nullptr && a.header.seq == b->header.seq && a.header.stamp == b->header.stamp &&
           same_bytes(ros::serialization::serializeMessage(a), ros::serialization::serializeMessage(*b));
  }

  std::unique_ptr<rosbag::View> view_;
  std::string topic_;
  rosbag::View::iterator at_;  // behind those that were read ahead
  std::deque<Held> ahead_;     // the present message and those behind it
  const std::size_t size_;
  boost::shared_ptr<Message> message_, last_, first_;
  Number number_;
  std::shared_ptr<const Starts> starts_;
  std::shared_ptr<std::exception_ptr> fault_;
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
  // Adds the bags that follow. `batches_between`: missing before them.
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
    return std::make_unique<Cursor<Message>>(view(topic<Message>()), starts(), fault_);
  }
  std::unique_ptr<rosbag::View> view(const std::string& topic, const ros::Time& begin = ros::TIME_MIN,
                                     const ros::Time& end = ros::TIME_MAX) const;
  struct Ends {
    std::optional<rosbag::MessageInstance> first, last;  // none, where a topic has no message
  };
  Ends ends_of(const std::string& topic) const;

  struct Missing {
    std::uint64_t at_beginning = 0, at_end = 0;
    std::uint64_t tolerated = 0;  // fewer, which a bag by `rosbag record` or of a killed node may lack
  };
  // Batches at the ends of every start of which it should hold a message of this type, but does not.
  template <class Message>
  Missing missing_at_ends() const {
    return missing_at_ends(ros::message_traits::datatype<Message>());
  }
  // 0 or 1: the node writes the command in force before the first snapshot; 1 if that message is missing.
  std::uint64_t commands_missing_at_beginning() const;
  bool is_by_node() const;  // not by rosbag record
  bool has_several_starts() const { return starts()->are_several(); }

 private:
  Missing missing_at_ends(const std::string& type) const;
  using EndsOfStarts = std::map<std::uint64_t, Ends>;  // by the start of the node
  const EndsOfStarts& ends_by_start(const std::string& topic) const;
  void add_missing(const std::string& type, std::uint64_t start, Missing& missing) const;
  // Of one start: batches before the first or after the last one that the bag holds. Other messages of the node prove
  // them.
  std::uint64_t batches_proved_at_beginning(std::uint64_t start) const;
  std::uint64_t batches_proved_at_end(std::uint64_t start) const;
  template <class Message>
  boost::shared_ptr<Message> first(std::uint64_t start) const;
  template <class Message>
  boost::shared_ptr<Message> last(std::uint64_t start) const;
  bool is_cut() const;  // nothing stands behind its last batch
  std::shared_ptr<const Starts> starts() const;

  std::string node_;
  Topics topics_;
  std::vector<File> files_;
  std::string holes_;  // between the files, in words
  // met by a cursor
  std::shared_ptr<std::exception_ptr> fault_ = std::make_shared<std::exception_ptr>();
  // once they were asked for
  mutable std::shared_ptr<const Starts> starts_;
  mutable std::map<std::string, EndsOfStarts> ends_;  // by topic
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
