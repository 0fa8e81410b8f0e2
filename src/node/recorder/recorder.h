// Writes every message it is given to a bag, in a thread of its own. A recording begins with a snapshot, and so does
// every bag of a split one. A disk that fills up or fails ends the recording, never the node.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "bag_file.h"

namespace afm::node {

// The role of a message: configuration and what is applied stand before the snapshot at the beginning of every bag.
// Every bag of a split recording has a whole batch, and a recording that is stopped waits for the end of the last one.
enum class Role { ordinary, batch, batch_end, configuration, applied, snapshot };

class Recorder {
 public:
  struct Settings {
    std::string directory;
    std::uint64_t reserve_bytes;
    std::uint64_t split_bytes;  // a new bag after so much; 0: never
    double split_seconds;       // of wall time; 0: never
    rosbag::CompressionType compression;
  };
  struct Reply {
    bool success = false;
    std::string message, path;
  };
  struct Status {
    std::string recording;                     // path of the bag being written, or empty
    std::string error;                         // why the last recording ended early, or empty
    std::uint64_t dropped_messages = 0;        // since the node began
    std::uint64_t dropped_from_recording = 0;  // the present or last one
  };

  // ask_for_snapshot: called by the recorder's thread when the bag is full; the next one begins with that snapshot.
  // False: it could not be asked for, and is asked for again.
  Recorder(const Settings& settings, std::function<bool()> ask_for_snapshot);
  ~Recorder();  // writes what waits and closes

  Reply start(const std::string& name);  // empty: that of the node, and the time. It begins with the next snapshot
  Reply stop();
  Status status() const;

  // A message that finds no room in the queue, as the disk is slow, is counted as dropped. An unhurried one waits.
  void record(const std::shared_ptr<const BagTopic>& topic, const ros::SerializedMessage& bytes, Role role,
              bool unhurried);

 private:
  struct Message {
    std::shared_ptr<const BagTopic> topic;  // what waits to be written outlives its publisher
    ros::SerializedMessage bytes;
  };
  struct Item {
    Message message;
    ros::Time stamp;
    Message configuration, applied;  // of a snapshot: what a bag that begins with it holds before it
    Role role = Role::ordinary;
  };

  void push(std::unique_lock<std::mutex>& lock, Item item, bool unhurried);
  void write_loop();
  std::string take(const Item& item);  // returns why the recording must end, or nothing
  void write(const Message& message, const ros::Time& stamp);
  void write(const Item& item);
  void write_held();
  bool is_full() const;
  void begin_next_bag();
  void finish(std::unique_lock<std::mutex>& lock, std::string error);
  bool splits() const { return settings_.split_bytes > 0 || settings_.split_seconds > 0.0; }
  std::string part_path(std::uint32_t part) const;
  std::string taken_part() const;
  std::string summary() const;  // of a recording that has ended

  const Settings settings_;
  const std::function<bool()> ask_for_snapshot_;
  mutable std::mutex mutex_;
  std::mutex orders_;  // one start or stop at a time: both take their time
  std::condition_variable work_, room_, settled_;  // settled: a batch has ended, or the bag is closed
  Message configuration_, applied_;  // the latest
  std::deque<Item> queue_;
  std::size_t queue_bytes_ = 0;
  std::unique_ptr<BagFile> bag_;  // written and closed by the thread alone
  std::string base_;              // of the recording: its directory and name, without an ending
  std::string path_;              // of the bag being written, or of the last one
  ros::Time last_stamp_;
  std::string error_;
  std::uint64_t messages_ = 0;                               // of this recording or the last one
  std::uint64_t dropped_messages_ = 0, dropped_before_ = 0;  // before this recording
  bool begun_ = false;                                       // its first snapshot has come
  bool is_within_batch_ = false;
  bool stopping_ = false, quitting_ = false;
  // of the thread alone
  std::uint32_t part_ = 0;
  std::chrono::steady_clock::time_point begin_;  // of the bag
  bool full_ = false;                            // a snapshot was asked for
  std::vector<Item> held_;                       // from this snapshot or epoch on, until the end of a batch
  std::size_t held_others_ = 0;                  // of these, those that are no commands
  std::thread thread_;
};

}  // namespace afm::node
