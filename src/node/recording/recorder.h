// Writes every message it is given to a bag, in a thread of its own. Start and stop at any time; a disk that fills up
// or fails ends the recording, never the node.
#pragma once

#include <ros/serialization.h>

#include <condition_variable>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

#include "bag_series.h"
#include "run_history.h"

namespace afm::node {

class Recorder {
 public:
  struct Settings {
    std::string directory;
    BagSeries::Settings bags;
  };
  struct Reply {
    bool success = false;
    std::string message, path;
  };
  struct Status {
    std::string recording;  // path of the bag being written, or empty
    std::string error;      // why the last recording ended early, or empty
    std::uint64_t dropped_messages = 0;        // since the node began
    std::uint64_t dropped_from_recording = 0;  // the present or last one
  };

  explicit Recorder(const Settings& settings);
  ~Recorder();  // writes what waits and closes

  Reply start(const std::string& name);  // empty: a name from the time
  Reply stop();
  Status status() const;
  bool is_recording() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return recording();
  }

  // Never waits for the disk. What finds no room in the queue is counted.
  template <class Message>
  void record(const BagTopic& topic, const boost::shared_ptr<const Message>& message) {
    const std::lock_guard<std::mutex> lock(mutex_);
    history_.remember(message);
    if (recording()) enqueue(topic, message);
  }

 private:
  struct Item {
    std::size_t bytes;
    std::function<void(BagSeries&)> write;
  };

  bool recording() const { return bags_ != nullptr && !stopping_; }
  template <class Message>
  void enqueue(const BagTopic& topic, const boost::shared_ptr<const Message>& message) {
    const ros::Time stamp = next_stamp();
    push({ros::serialization::serializationLength(*message),
          [topic, stamp, message](BagSeries& bags) { bags.write(topic, stamp, message); }});
  }
  void push(Item item);
  ros::Time next_stamp();
  void enqueue_history();
  std::unique_ptr<BagSeries> open(const std::string& name) const;

  void write_loop();
  std::string write(const Item& item);  // returns why the recording must end, or nothing
  void finish(std::unique_lock<std::mutex>& lock, std::string error);

  const Settings settings_;
  mutable std::mutex mutex_;
  std::mutex starting_;  // one start at a time, as opening a bag takes its time
  std::condition_variable work_, closed_;
  RunHistory history_;
  std::deque<Item> queue_;
  std::size_t queue_bytes_ = 0;
  std::unique_ptr<BagSeries> bags_;  // written and closed by the thread alone
  std::string path_;                 // of the bag being written, or of the last one
  ros::Time last_stamp_;
  std::string error_;
  std::uint64_t last_messages_ = 0;
  std::uint64_t dropped_messages_ = 0, dropped_before_ = 0;  // before this recording
  bool stopping_ = false, quitting_ = false;
  std::thread thread_;
};

}  // namespace afm::node
