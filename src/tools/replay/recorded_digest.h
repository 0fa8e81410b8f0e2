// Whether a recording is what was published: its messages against the digests that were recorded with them. Needs no
// simulation.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "batches.h"
#include "message_difference.h"
#include "node/wire/run_digest.h"
#include "run_log.h"

namespace afm::replay {

class RecordedDigest {
 public:
  // A digest, and where what was recorded since the one before contradicts it.
  using OnDigest = std::function<void(const afm_emulator::Digest&, const std::optional<FieldDifference>&)>;

  RecordedDigest(const Recording& recording, const RunLog& log);

  // Batches in order. Tells of the digests that stand right after this one.
  void follow(const RecordedBatch& batch, const OnDigest& on_digest);

 private:
  void begin_epoch(const RecordedBatch& batch);
  void add(const RecordedBatch& batch);
  std::optional<FieldDifference> check(const afm_emulator::Digest& recorded);
  void count_commands(const EpochLog& log, std::uint64_t commands);

  const RunLog& log_;
  MessageStream<afm_emulator::Digest> digests_;
  node::RunDigest digest_;
  node::RunDigest commands_;  // of those before the last digest
  std::size_t next_command_ = 0;
  std::optional<std::uint32_t> epoch_, last_batch_;
  bool whole_ = false;  // nothing is missing since the last digest, or the beginning of the epoch
};

}  // namespace afm::replay
