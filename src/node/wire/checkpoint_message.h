// The complete state of a run as a message, and back. Pure functions, as a checker makes the same message again.
#pragma once

#include <afm_emulator/Checkpoint.h>

#include <cstdint>
#include <optional>

#include "afm/emulator.h"
#include "node/parameters/live_parameters.h"
#include "node/stepping/events.h"
#include "run_digest.h"

namespace afm::node {

// What a checkpoint reports beside the state itself.
struct CheckpointContext {
  std::uint32_t epoch = 0;
  std::uint64_t drags = 0;                           // applied in this epoch
  std::uint32_t next_drag = 0, next_parameters = 0;  // sequence numbers of the messages
  double drag_velocity = 0.0;                        // in force [m/s], like the next
  LiveParameters live;
};

// All but the header. `digest`: of all that was published before.
afm_emulator::Checkpoint to_checkpoint(const CheckpointContext& context, const ModelTime& time, std::uint64_t impacts,
                                       std::uint64_t samples, const RunDigest& digest, const SavedState& state);

std::uint64_t digest_of(afm_emulator::Checkpoint checkpoint);  // what state_digest should be

// Changes of parameters that took effect before it.
inline std::uint64_t changes_before(const afm_emulator::Checkpoint& checkpoint) {
  return checkpoint.digest.commands - checkpoint.drags;
}

// Nothing: the state is none that a run can be in, or not the one that the rest of the message describes.
// Precondition: of our layout.
std::optional<Emulator> restored(const afm_emulator::Checkpoint& checkpoint);

}  // namespace afm::node
