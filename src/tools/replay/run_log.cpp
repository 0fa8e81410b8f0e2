#include "run_log.h"

#include <afm_emulator/Deflection.h>
#include <afm_emulator/Digest.h>
#include <afm_emulator/Friction.h>
#include <afm_emulator/ImpactArray.h>

#include <limits>

#include "message_difference.h"
#include "message_stream.h"
#include "node/wire/checkpoint_message.h"
#include "node/wire/message_conversion.h"
#include "node/wire/topics.h"

namespace afm::replay {
namespace {

// Bags that follow on repeat the history: the same must be reported again.
template <class Message>
void check_repeated(const Message& known, const Message& again, const std::string& where) {
  const auto difference = find_difference(known, again);
  if (!difference) return;
  throw Problem(Verdict::altered, where + ": " + difference->field + " is " + difference->second + ", and was " +
                                      difference->first + " when it was recorded before");
}

template <class Message>
MessageStream<Message> stream_of(const Recording& recording, const char* topic) {
  MessageStream<Message> stream(recording.topic(topic));
  for (const auto& bag : recording.bags()) stream.add(bag->bag, bag->path);
  return stream;
}

// Parts that are not there say nothing.
FirstBatch first_batch_of(const Recording& recording) {
  const auto deflection = stream_of<afm_emulator::Deflection>(recording, node::kDeflectionTopic);
  const auto impacts = stream_of<afm_emulator::ImpactArray>(recording, node::kImpactsTopic);
  const auto friction = stream_of<afm_emulator::Friction>(recording, node::kFrictionTopic);
  constexpr auto kAny = std::numeric_limits<std::uint64_t>::max();
  FirstBatch first{std::numeric_limits<std::uint32_t>::max(), kAny, kAny, kEndOfTime};
  const auto is_first = [&](const auto* message) {
    if (message != nullptr && message->epoch < first.epoch) first = {message->epoch, kAny, kAny, kEndOfTime};
    return message != nullptr && message->epoch == first.epoch;
  };
  if (is_first(deflection.head())) first.sample = deflection.head()->first_sample;
  if (is_first(impacts.head())) first.impact = impacts.head()->first_index;
  if (is_first(friction.head())) first.end = node::from_message(friction.head()->time);
  return first;
}

[[noreturn]] void lost(const std::string& where, std::uint64_t count) {
  throw Problem(Verdict::missing, where + ": " + std::to_string(count) + " messages are missing");
}

// Every message of a topic in one bag, with none missing between them.
template <class Message, class Take>
void for_each_in_order(const Recording& recording, const RecordedBag& bag, const char* topic, const Take& take) {
  MessageStream<Message> stream(recording.topic(topic));
  stream.add(bag.bag, bag.path);
  const std::string where = bag.path + ": " + stream.topic();
  std::optional<std::uint32_t> previous;
  for (; stream.head() != nullptr; stream.pop()) {
    const std::uint32_t sequence = stream.head()->header.seq;
    const std::uint64_t gap = previous ? follows(*previous, sequence, where) : 0;
    if (gap > 0) lost(where, gap);
    previous = sequence;
    take(*stream.head(), where);
  }
}

}  // namespace

RunLog::RunLog(const Recording& recording) {
  for (const auto& bag : recording.bags()) {
    MessageStream<afm_emulator::Configuration> configurations(recording.topic(node::kConfigurationTopic));
    configurations.add(bag->bag, bag->path);
    const std::string where = bag->path + ": " + configurations.topic();
    for (; configurations.head() != nullptr; configurations.pop()) take(*configurations.head(), where);
    for_each_in_order<afm_emulator::Checkpoint>(
        recording, *bag, node::kCheckpointTopic,
        [&](const afm_emulator::Checkpoint& checkpoint, const std::string& place) { take(checkpoint, place); });
    take_all(recording, *bag, node::kAppliedDragTopic, drags_);
    take_all(recording, *bag, node::kAppliedParametersTopic, changes_);
    take_stretches(recording, *bag);
  }
  const FirstBatch first = first_batch_of(recording);
  for (auto& [number, log] : epochs_) log.put_in_order(first);
}

const EpochLog& RunLog::epoch(std::uint32_t number) const {
  const auto found = epochs_.find(number);
  if (found != epochs_.end()) return found->second;
  throw Problem(Verdict::missing, "epoch " + std::to_string(number) + ": its configuration is missing");
}

void RunLog::take(const afm_emulator::Configuration& configuration, const std::string& where) {
  const auto known = epochs_.find(configuration.epoch);
  if (known != epochs_.end()) return check_repeated(known->second.configuration, configuration, where);
  if (last_configuration_ != nullptr) {
    const std::uint64_t gap = follows(last_configuration_->header.seq, configuration.header.seq, where);
    if (gap > 0) lost(where, gap);
    follows(last_configuration_->epoch, configuration.epoch, where + ": epoch");
  }
  EpochLog& log = epochs_[configuration.epoch];
  log.configuration = configuration;
  last_configuration_ = &log.configuration;
}

// A bag that follows on begins with one that was reported before.
void RunLog::take(const afm_emulator::Checkpoint& checkpoint, const std::string& where) {
  epoch(checkpoint.epoch);
  if (node::digest_of(checkpoint) != checkpoint.state_digest) {
    throw Problem(Verdict::altered, where + ": number " + std::to_string(checkpoint.header.seq) +
                                        " is not as it was recorded: its digest is another");
  }
  auto& checkpoints = epochs_[checkpoint.epoch].checkpoints;
  for (const auto& known : checkpoints) {
    if (known.header.seq == checkpoint.header.seq) return check_repeated(known, checkpoint, where);
  }
  const std::uint64_t gap = last_checkpoint_ ? follows(*last_checkpoint_, checkpoint.header.seq, where) : 0;
  if (gap > 0) lost(where, gap);
  last_checkpoint_ = checkpoint.header.seq;
  checkpoints.push_back(checkpoint);
  epochs_[checkpoint.epoch].stretches.insert(checkpoint.digest.first_sample);
}

template <class Message>
void RunLog::take_all(const Recording& recording, const RecordedBag& bag, const char* topic, Kind<Message>& kind) {
  for_each_in_order<Message>(recording, bag, topic, [&](const Message& message, const std::string& where) {
    take(message, where, kind);
  });
}

void RunLog::take_stretches(const Recording& recording, const RecordedBag& bag) {
  MessageStream<afm_emulator::Digest> digests(recording.topic(node::kDigestTopic));
  digests.add(bag.bag, bag.path);
  for (; digests.head() != nullptr; digests.pop()) {
    const auto known = epochs_.find(digests.head()->epoch);
    if (known != epochs_.end()) known->second.stretches.insert(digests.head()->first_sample);
  }
}

template <class Message>
void RunLog::take(const Message& message, const std::string& where, Kind<Message>& kind) {
  const std::uint32_t sequence = message.header.seq;
  epoch(message.epoch);
  auto& messages = epochs_[message.epoch].*kind.messages;
  if (kind.last && sequence <= *kind.last) {
    const bool known = !messages.empty() && sequence >= messages.front().header.seq;
    const std::size_t index = known ? sequence - messages.front().header.seq : 0;
    if (known && index < messages.size()) return check_repeated(messages[index], message, where);
  }
  const std::uint64_t gap = kind.last ? follows(*kind.last, sequence, where) : 0;
  if (gap > 0) lost(where, gap);
  kind.last = sequence;
  messages.push_back(message);
}

}  // namespace afm::replay
