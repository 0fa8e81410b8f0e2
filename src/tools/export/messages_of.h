// All messages of one topic of a recording, in order, one at a time in memory.
#pragma once

#include <string>

#include "tools/replay/message_stream.h"
#include "tools/replay/recording.h"

namespace afm {

// take(message) for each; the name of the topic without the node's. Throws replay::Problem where one cannot be read.
template <class Message, class Take>
void for_each_message(const replay::Recording& recording, const std::string& topic, const Take& take) {
  replay::MessageStream<Message> messages(recording.topic(topic));
  for (const auto& bag : recording.bags()) messages.add(bag->bag, bag->path);
  for (; messages.head() != nullptr; messages.pop()) take(*messages.head());
}

}  // namespace afm
