#include "checkpoint_message.h"

#include <algorithm>

#include "message_bytes.h"
#include "message_conversion.h"

namespace afm::node {

afm_emulator::Checkpoint to_checkpoint(const CheckpointContext& context, const ModelTime& time, std::uint64_t impacts,
                                       std::uint64_t samples, const RunDigest& digest, const SavedState& state) {
  afm_emulator::Checkpoint message;
  message.epoch = context.epoch;
  message.time = to_message(time);
  message.impacts = impacts;
  message.samples = samples;
  message.drags = context.drags;
  message.next_drag = context.next_drag;
  message.next_parameters = context.next_parameters;
  message.drag_velocity = context.drag_velocity;
  write_live(context.live, message);
  message.digest = digest.message();
  message.layout = state_layout();
  message.state.assign(state.begin(), state.end());
  message.state_digest = digest_of(message);
  return message;
}

std::uint64_t digest_of(afm_emulator::Checkpoint checkpoint) {
  checkpoint.state_digest = 0;
  return digest_of_message(checkpoint);
}

std::optional<Emulator> restored(const afm_emulator::Checkpoint& c) {
  SavedState state;
  if (c.state.size() > state.words.size()) return {};
  std::copy(c.state.begin(), c.state.end(), state.words.begin());
  state.size = c.state.size();
  auto emulator = Emulator::restored(state);
  const bool agrees = emulator && emulator->now() == from_message(c.time) && emulator->impacts() == c.impacts &&
                      emulator->samples() == c.samples;
  return agrees ? emulator : std::nullopt;
}

}  // namespace afm::node
