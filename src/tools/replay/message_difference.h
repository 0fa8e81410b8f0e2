// Where two messages differ, bit for bit. Stamps and sequence numbers belong to their moment and are not compared.
#pragma once

#include <afm_emulator/ImpactArray.h>
#include <ros/message_traits.h>

#include <optional>

#include "node/wire/message_bytes.h"
#include "printed_fields.h"

namespace afm::replay {

// The first field that differs. The bytes on the wire decide; names and values are those that ROS prints. Nothing here
// lists the fields of a message.
template <class Message>
std::optional<FieldDifference> find_difference(const Message& a, const Message& b) {
  if (node::bytes_of(a) == node::bytes_of(b)) return {};
  Message first = a, second = b;
  node::clear_headers(first);
  node::clear_headers(second);
  const std::string name = topic_name(ros::message_traits::datatype<Message>());
  return first_difference(printed_fields(name, first), printed_fields(name, second));
}

// Impact by impact: the answer has the index of the first that differs.
std::optional<FieldDifference> find_difference(const afm_emulator::ImpactArray& a, const afm_emulator::ImpactArray& b);

}  // namespace afm::replay
