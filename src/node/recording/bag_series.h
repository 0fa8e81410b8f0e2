// The bags of one recording, one after another: each can be read without the others, as it begins with the history of
// the run so far, and each ends with a mark. Used by the recorder's thread alone.
#pragma once

#include <afm_emulator/Deflection.h>
#include <afm_emulator/Recording.h>

#include <cstdint>
#include <memory>
#include <string>
#include <type_traits>

#include "bag_file.h"
#include "run_history.h"

namespace afm::node {

class BagSeries {
 public:
  struct Topics {
    BagTopic configuration, checkpoint, applied_drag, applied_parameters, recording;
  };
  struct Settings {
    Topics topics;
    std::uint64_t reserve_bytes;
    std::uint64_t split_bytes;  // a new bag after so much, at the next batch; 0: never
    double split_seconds;       // of stamps; 0: never
    rosbag::CompressionType compression;
  };

  // directory/NAME.bag, and directory/NAME_001.bag and so on where it is split. Throws std::runtime_error with the
  // reason.
  BagSeries(const Settings& settings, const std::string& directory, const std::string& name);

  // In order of stamps. Throws std::exception; then nothing but close() is left to do.
  template <class Message>
  void write(const BagTopic& topic, const ros::Time& stamp, const boost::shared_ptr<const Message>& message) {
    // between batches: every bag holds whole ones, and the last at least one
    if (std::is_same<Message, afm_emulator::Deflection>::value && begun_ && is_full(stamp)) split();
    if (!begun_) begin_bag(stamp);
    history_.remember(message);
    epoch_ = message->epoch;
    bag_->write(topic, stamp, *message);
    last_stamp_ = stamp;
  }

  // How many messages the recorder has dropped so far, from the marks.
  void set_dropped(std::uint64_t messages) { dropped_ = messages; }
  std::string find_trouble(std::uint64_t bytes) { return bag_->find_trouble_before_writing(bytes); }
  std::string close();  // returns what went wrong, or nothing

  const std::string& path() const { return bag_->path(); }  // of the present bag
  std::uint64_t messages() const { return earlier_messages_ + bag_->messages(); }

 private:
  std::unique_ptr<BagFile> open(std::uint32_t part) const;
  void begin_bag(const ros::Time& stamp);
  bool is_full(const ros::Time& stamp) const;
  void split();
  void write_history();
  void mark(std::uint8_t kind, const ros::Time& stamp);

  const Settings settings_;
  const std::string directory_, name_;
  std::unique_ptr<BagFile> bag_;
  RunHistory history_;  // of what was written
  std::uint32_t part_ = 0, epoch_ = 0, marks_ = 0;
  std::uint64_t earlier_messages_ = 0, dropped_ = 0;
  bool begun_ = false;  // the present bag
  ros::Time begin_stamp_, last_stamp_;
};

}  // namespace afm::node
