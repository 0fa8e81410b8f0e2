#include "checkpoint_message.h"

#include <algorithm>

#include "digest.h"
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

std::uint64_t digest_of(const afm_emulator::Checkpoint& c) {
  Digest digest;
  const auto add_time = [&](const afm_emulator::ModelTime& time) {
    digest.add(static_cast<std::uint64_t>(time.tau));
    digest.add(time.phase);
  };
  digest.add(std::uint64_t{c.epoch});
  add_time(c.time);
  for (const std::uint64_t n : {c.impacts, c.samples, c.drags}) digest.add(n);
  for (const std::uint32_t n : {c.next_drag, c.next_parameters}) digest.add(std::uint64_t{n});
  for (const double value : {c.drag_velocity, c.restitution_gamma, c.cutoff_speed, c.rest_height_m, c.sample_rate_hz,
                             c.friction_window_tau}) {
    digest.add(value);
  }
  const afm_emulator::Digest& d = c.digest;
  digest.add(std::uint64_t{d.epoch});
  add_time(d.time);
  for (const std::uint64_t n : {d.samples, d.impacts, d.commands, d.estimates, d.configuration_digest, d.first_sample,
                                d.samples_digest, d.impacts_digest, d.commands_digest, d.estimates_digest}) {
    digest.add(n);
  }
  digest.add(std::uint64_t{c.layout});
  for (const std::uint64_t word : c.state) digest.add(word);
  return digest.value();
}

std::optional<Emulator> restored(const afm_emulator::Checkpoint& c) {
  SavedState state;
  if (c.state.size() > state.words.size()) return {};
  std::copy(c.state.begin(), c.state.end(), state.words.begin());
  state.size = c.state.size();
  auto emulator = Emulator::restored(state);
  const bool as_told = emulator && emulator->now() == from_message(c.time) && emulator->impacts() == c.impacts &&
                       emulator->samples() == c.samples;
  return as_told ? emulator : std::nullopt;
}

}  // namespace afm::node
