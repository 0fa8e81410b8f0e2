#include "recorded_digest.h"

#include "node/wire/message_conversion.h"
#include "node/wire/topics.h"

namespace afm::replay {

RecordedDigest::RecordedDigest(const Recording& recording, const RunLog& log)
    : log_(log), digests_(recording.topic(node::kDigestTopic)) {
  for (const auto& bag : recording.bags()) digests_.add(bag->bag, bag->path);
}

// A recording begun in mid-run can be judged from its first digest on.
void RecordedDigest::begin_epoch(const RecordedBatch& batch) {
  epoch_ = batch.epoch;
  last_batch_.reset();
  digest_ = node::RunDigest(log_.epoch(batch.epoch).configuration);
  commands_ = log_.epoch(batch.epoch).digest();
  next_command_ = 0;
  whole_ = batch.is_whole() && batch.deflection->first_sample == 0 && batch.impacts->first_index == 0;
}

void RecordedDigest::add(const RecordedBatch& batch) {
  const bool follows_on = !last_batch_ || batch.sequence == *last_batch_ + 1;
  whole_ = whole_ && follows_on && batch.is_whole();
  last_batch_ = batch.sequence;
  if (!batch.is_whole()) return;
  digest_.add(*batch.deflection);
  digest_.add(*batch.impacts);
  digest_.add(*batch.friction);
}

// Found by their counts, as times may be what was altered. Digests of batches that are not there are passed over.
void RecordedDigest::follow(const RecordedBatch& batch, const OnDigest& on_digest) {
  if (epoch_ != batch.epoch) begin_epoch(batch);
  add(batch);
  if (!batch.is_whole()) return;
  const ModelTime end = node::from_message(batch.friction->time);
  const std::uint64_t samples = end_of(*batch.deflection), impacts = end_of(*batch.impacts);
  for (; digests_.head() != nullptr; digests_.pop()) {
    const afm_emulator::Digest& recorded = *digests_.head();
    if (recorded.epoch > batch.epoch) return;
    if (recorded.epoch < batch.epoch) continue;
    if (recorded.samples > samples || recorded.impacts > impacts) return;
    if (recorded.samples < samples || recorded.impacts < impacts) continue;
    if (end < node::from_message(recorded.time)) return;  // a batch without samples and impacts is still to come
    on_digest(recorded, check(recorded));
  }
}

// They are known from the beginning of the epoch on, or from a checkpoint that knows the digest of those before it.
void RecordedDigest::count_commands(const EpochLog& log, std::uint64_t commands) {
  if (commands < log.commands_before() + next_command_) {
    commands_ = log.digest();
    next_command_ = 0;
  }
  for (; next_command_ < log.commands.size() && log.commands_before() + next_command_ < commands; ++next_command_) {
    std::visit([this](const auto& command) { commands_.add(command); }, log.commands[next_command_]);
  }
}

std::optional<FieldDifference> RecordedDigest::check(const afm_emulator::Digest& recorded) {
  const EpochLog& log = log_.epoch(recorded.epoch);
  count_commands(log, recorded.commands);
  afm_emulator::Digest found = whole_ ? digest_.message() : recorded;
  found.commands = commands_.message().commands;
  found.commands_digest = commands_.message().commands_digest;
  found.configuration_digest = node::RunDigest(log.configuration).message().configuration_digest;
  digest_ = node::RunDigest(recorded);
  whole_ = true;
  return find_difference(found, recorded);
}

}  // namespace afm::replay
