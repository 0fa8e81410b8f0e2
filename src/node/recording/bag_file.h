// A bag that is being written: NAME.bag.active until it is closed, then NAME.bag. It keeps a reserve on its disk free,
// and no failure of the disk takes the process down.
#pragma once

#include <ros/datatypes.h>
#include <ros/time.h>
#include <rosbag/bag.h>

#include <boost/shared_ptr.hpp>
#include <cstdint>
#include <memory>
#include <string>

namespace afm::node {

// Where a message goes in the bag. The connection header says what rosbag play must know, such as latching.
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
  template <class Message>
  void write(const BagTopic& topic, const ros::Time& stamp, const Message& message) {
    bag_->write(topic.name, stamp, message, topic.connection_header);
    ++messages_;
  }

  // Why so much more had better not be written: no room beside the reserve, or the file is gone. Nothing: it can be.
  std::string find_trouble(std::uint64_t bytes) const;
  // The same, asking the disk only now and then, as that takes a system call.
  std::string find_trouble_before_writing(std::uint64_t bytes);

  std::string close();  // returns what went wrong, with what to do about it, or nothing

  const std::string& path() const { return path_; }  // NAME.bag, where it will be
  std::uint64_t messages() const { return messages_; }
  std::uint64_t bytes() const { return bag_->getSize(); }  // on disk

 private:
  std::string path_, active_path_;
  std::uint64_t reserve_bytes_;
  std::uint64_t messages_ = 0;
  std::uint64_t bytes_allowed_ = 0;  // that may be written before the disk is asked again
  std::unique_ptr<rosbag::Bag> bag_;
};

}  // namespace afm::node
