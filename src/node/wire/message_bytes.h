// A message as the bytes that ROS sends, its headers left empty. Digests cover these bytes and replays compare them, so a
// field that is added to a message needs no entry anywhere else.
#pragma once

#include <afm_emulator/Checkpoint.h>
#include <afm_emulator/Impact.h>
#include <ros/serialization.h>
#include <std_msgs/Header.h>

#include <cstdint>
#include <vector>

#include "digest.h"

namespace afm::node {

template <class Message>
void clear_headers(Message& message) {
  message.header = std_msgs::Header();
}
inline void clear_headers(afm_emulator::Checkpoint& message) {
  message.header = std_msgs::Header();
  message.digest.header = std_msgs::Header();
}
inline void clear_headers(afm_emulator::Impact&) {}

template <class Message>
std::vector<std::uint8_t> bytes_of(Message message) {
  clear_headers(message);
  std::vector<std::uint8_t> bytes(ros::serialization::serializationLength(message));
  ros::serialization::OStream stream(bytes.data(), static_cast<std::uint32_t>(bytes.size()));
  ros::serialization::serialize(stream, message);
  return bytes;
}

template <class Message>
void add_message(const Message& message, Digest& digest) {
  const auto bytes = bytes_of(message);
  digest.add(bytes.data(), bytes.size());
}

// By itself.
template <class Message>
std::uint64_t digest_of_message(const Message& message) {
  Digest digest;
  add_message(message, digest);
  return digest.value();
}

}  // namespace afm::node
