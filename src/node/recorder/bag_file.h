// A bag that is being written: NAME.bag.active until it is closed, then NAME.bag. It keeps a reserve on its disk free,
// and no failure of the disk takes the process down.
#pragma once

#include <rosbag/bag.h>
#include <topic_tools/shape_shifter.h>

#include <cstdint>
#include <memory>
#include <string>

namespace afm::node {

// A topic as a bag describes it, for readers such as rosbag play.
struct BagTopic {
  std::string name;
  boost::shared_ptr<ros::M_string> connection_header;
};

class BagFile {
 public:
  // Throws std::runtime_error with the reason.
  BagFile(const std::string& path, std::uint64_t reserve_bytes, rosbag::CompressionType compression);
  ~BagFile();  // closes, whatever happens
  BagFile(const BagFile&) = delete;
  BagFile& operator=(const BagFile&) = delete;

  // Throws rosbag::BagException.
  void write(const BagTopic& topic, const ros::Time& stamp, const ros::SerializedMessage& message) {
    ros::serialization::IStream bytes(message.message_start, static_cast<std::uint32_t>(message.num_bytes - 4));
    message_.read(bytes);  // behind their length
    bag_->write(topic.name, stamp, message_, topic.connection_header);
    ++messages_;
  }

  // Why so many bytes cannot be written: no room beside the reserve, or the file is gone. Empty: they can be. It asks
  // the disk only now and then, as that takes a system call.
  std::string check_space(std::uint64_t bytes);

  std::string close();  // returns what went wrong, with what to do about it, or nothing

  const std::string& path() const { return path_; }  // NAME.bag, where it will be
  std::uint64_t messages() const { return messages_; }
  std::uint64_t bytes() const { return bag_->getSize(); }  // on disk

 private:
  std::string ask_disk(std::uint64_t bytes) const;

  std::string path_, active_path_;
  std::uint64_t reserve_bytes_;
  std::uint64_t messages_ = 0;
  std::uint64_t bytes_allowed_ = 0;  // that may be written before the disk is asked again
  std::unique_ptr<rosbag::Bag> bag_;
  topic_tools::ShapeShifter message_;  // of any type: that is in the connection header
};

}  // namespace afm::node
