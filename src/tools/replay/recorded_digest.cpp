#include "recorded_digest.h"

namespace afm::replay {

void RecordedDigest::begin(std::uint32_t epoch) {
  if (epoch == epoch_) return;
  epoch_ = epoch;
  digest_ = node::RunDigest(log_.epoch(epoch).configuration);
  whole_ = true;
}

std::optional<FieldDifference> RecordedDigest::check(const afm_emulator::Digest& told) {
  begin(told.epoch);
  // commands are known from the beginning of the epoch on, wherever the recording was begun
  const EpochLog& log = log_.epoch(told.epoch);
  node::RunDigest commands(log.configuration);
  for (std::size_t i = 0; i < log.commands.size() && i < told.commands; ++i) commands.add(log.commands[i]);
  afm_emulator::Digest found = whole_ ? digest_.message() : told;
  found.commands = commands.message().commands;
  found.commands_digest = commands.message().commands_digest;
  found.configuration_digest = commands.message().configuration_digest;
  digest_ = node::RunDigest(told);
  whole_ = true;
  ++checked_;
  return find_difference(found, told);
}

}  // namespace afm::replay
