#include "batches.h"

#include <cstdio>

#include "afm/detail/sample_grid.h"
#include "node/wire/topics.h"

namespace afm::replay {
namespace {

template <class Message>
std::optional<std::uint32_t> sequence(const MessageStream<Message>& stream) {
  return stream.head() == nullptr ? std::nullopt : std::optional<std::uint32_t>(stream.head()->header.seq);
}

void check(const afm_emulator::ModelTime& time, const std::string& what) {
  if (time.tau >= 0 && time.tau <= kEndOfTime.tau && time.phase >= 0.0 && time.phase < 1.0) return;
  char text[96];
  std::snprintf(text, sizeof text, " is %lld + %.17g tau, when no run can be", static_cast<long long>(time.tau),
                time.phase);
  throw Problem(Verdict::altered, what + text);
}

template <class Message>
void check_times(const Message& message, const std::string& what) {
  check(message.time, what);
}

template <>
void check_times(const afm_emulator::ImpactArray& message, const std::string& what) {
  for (const auto& impact : message.impacts) check(impact.time, what);
}

// Takes the message with this number, if it is there. Throws where the numbers of a topic do not rise.
template <class Message>
boost::shared_ptr<const Message> take(MessageStream<Message>& stream, std::uint32_t number) {
  if (sequence(stream) != number) return nullptr;
  auto message = stream.shared_head();
  check_times(*message, stream.path() + ": " + stream.topic() + ": the time of batch " + std::to_string(number));
  stream.pop();
  if (const auto following = sequence(stream)) follows(number, *following, stream.path() + ": " + stream.topic());
  return message;
}

template <class Message>
void note(const boost::shared_ptr<const Message>& message, std::optional<std::uint32_t>& epoch) {
  if (!message) return;
  if (epoch && *epoch != message->epoch) {
    throw Problem(Verdict::altered, "batch " + std::to_string(message->header.seq) + " is of epoch " +
                                        std::to_string(*epoch) + " and of epoch " + std::to_string(message->epoch));
  }
  epoch = message->epoch;
}

}  // namespace

Batches::Batches(const Recording& recording)
    : deflection_(recording.topic(node::kDeflectionTopic)),
      impacts_(recording.topic(node::kImpactsTopic)),
      friction_(recording.topic(node::kFrictionTopic)) {
  for (const auto& bag : recording.bags()) {
    deflection_.add(bag->bag, bag->path);
    impacts_.add(bag->bag, bag->path);
    friction_.add(bag->bag, bag->path);
  }
  size_ = std::max({deflection_.size(), impacts_.size(), friction_.size()});
  const std::uint64_t least = std::min({deflection_.size(), impacts_.size(), friction_.size()});
  if (size_ == 0) throw Problem(Verdict::missing, recording.name() + ": holds no batch of the run");
  if (deflection_.size() == 0 || (least == 0 && size_ > 1))
    throw Problem(Verdict::missing, recording.name() + ": a whole topic is missing");
}

bool Batches::next(RecordedBatch& batch) {
  std::optional<std::uint32_t> least;
  for (const auto& number : {sequence(deflection_), sequence(impacts_), sequence(friction_)}) {
    if (number && (!least || *number < *least)) least = number;
  }
  note_cuts(!least);
  if (!least) return false;
  if (last_) note_gap(3 * std::uint64_t{*least - last_->sequence - 1}, *least);
  batch = {};
  batch.sequence = *least;
  batch.deflection = take(deflection_, *least);
  batch.impacts = take(impacts_, *least);
  batch.friction = take(friction_, *least);
  std::optional<std::uint32_t> epoch;
  note(batch.deflection, epoch);
  note(batch.impacts, epoch);
  note(batch.friction, epoch);
  batch.epoch = *epoch;
  last_ = batch;
  ++read_;
  return true;
}

void Batches::note_gap(std::uint64_t messages, std::uint32_t before) {
  if (messages > 0 && gaps_.messages == 0) gaps_.first = "before batch " + std::to_string(before);
  gaps_.messages += messages;
}

// A batch is published as deflection, impacts, friction: a recording may begin, or end, between them.
void Batches::note_cuts(bool at_end) {
  if (!last_ || last_->is_whole()) return;
  const bool lacks[] = {!last_->deflection, !last_->impacts, !last_->friction};
  const bool cut_before = read_ == 1 && !lacks[2] && !(lacks[1] && !lacks[0]);
  const bool cut_after = at_end && !lacks[0] && !(lacks[1] && !lacks[2]);
  if (cut_before || cut_after) return;
  note_gap(static_cast<std::uint64_t>(lacks[0] + lacks[1] + lacks[2]), last_->sequence + 1);
}

}  // namespace afm::replay
