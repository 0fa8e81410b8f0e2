// A message as the bytes that ROS sends and rosbag stores. It is serialized once; published, recorded and compared
// bytes are the same.
#pragma once

#include <ros/message_traits.h>
#include <ros/serialization.h>
#include <ros/time.h>

#include <boost/shared_ptr.hpp>
#include <cstdint>
#include <cstring>
#include <string>

namespace afm::node {

struct MessageBytes {
  ros::SerializedMessage message;  // its length, four bytes, and the bytes

  std::uint8_t* begin() const { return message.message_start; }
  std::uint32_t size() const { return static_cast<std::uint32_t>(message.num_bytes - 4); }
};

template <class Message>
MessageBytes to_bytes(const Message& message) {
  return {ros::serialization::serializeMessage(message)};
}

// A topic as a bag describes it, for readers such as rosbag play.
struct BagTopic {
  std::string name;
  boost::shared_ptr<ros::M_string> connection_header;
};

}  // namespace afm::node

// Only what rosbag::Bag::write() asks for: it takes the type from the connection header.
namespace ros::message_traits {
template <>
struct MD5Sum<afm::node::MessageBytes> {
  static const char* value(const afm::node::MessageBytes&) { return "*"; }
};
template <>
struct DataType<afm::node::MessageBytes> {
  static const char* value(const afm::node::MessageBytes&) { return "*"; }
};
template <>
struct Definition<afm::node::MessageBytes> {
  static const char* value(const afm::node::MessageBytes&) { return ""; }
};
}  // namespace ros::message_traits

namespace ros::serialization {
template <>
struct Serializer<afm::node::MessageBytes> {
  template <class Stream>
  static void write(Stream& stream, const afm::node::MessageBytes& bytes) {
    std::memcpy(stream.advance(bytes.size()), bytes.begin(), bytes.size());
  }
  static std::uint32_t serializedLength(const afm::node::MessageBytes& bytes) { return bytes.size(); }
};
}  // namespace ros::serialization
