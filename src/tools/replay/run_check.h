// A recording against the run simulated again: every sample, impact, friction value and command, bit for bit.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "batches.h"
#include "message_difference.h"
#include "recorded_digest.h"
#include "recording.h"
#include "resimulation.h"
#include "run_log.h"

namespace afm::replay {

// What was compared.
struct Extent {
  std::uint64_t samples = 0, impacts = 0, estimates = 0, commands = 0, epochs = 0, digests = 0;
  std::uint64_t checkpoints = 0;
  double model_seconds = 0.0;     // simulated
  double compared_seconds = 0.0;  // of model time, in the recording
};

// The first difference, with what a person needs to find it.
struct Difference {
  FieldDifference field;  // recorded, simulated
  std::uint32_t epoch = 0, batch = 0;
  ModelTime time;
  std::optional<Applied> last_command;
  std::optional<bool> altered;  // whether the recording contradicts its own digests there; unknown without one
};

using Progress = std::function<void(double part_done, const ModelTime& time)>;

class RunCheck {
 public:
  RunCheck(const Recording& recording, Progress progress);

  void run();  // throws Problem

  const Extent& extent() const { return extent_; }
  const std::optional<Difference>& difference() const { return difference_; }
  const Gaps& gaps() const { return batches_.gaps(); }
  const Gaps& unpublished() const { return unpublished_; }  // what the emulator itself had to let go
  const RunLog& log() const { return log_; }
  ModelTime end() const { return end_; }

 private:
  void begin_epoch(const RecordedBatch& batch);
  void compare(const RecordedBatch& batch);
  bool is_plausible(const RecordedBatch& batch);
  std::uint64_t missing_before(const RecordedBatch& batch) const;
  bool follows_on(const RecordedBatch& batch);
  bool is_at_its_time(const RecordedBatch& batch) const;
  ModelTime latest_end(const RecordedBatch& batch) const;
  bool ends_in_time(const RecordedBatch& batch) const;
  void run_to_end_of(const RecordedBatch& batch);
  template <class Message>
  void expect_same(const RecordedBatch& batch, const Message& recorded, const Message& simulated);
  void differ(const RecordedBatch& batch, const FieldDifference& field, const ModelTime& time);
  void check_checkpoints(const RecordedBatch& batch, std::uint64_t most_commands);
  void check_checkpoint(const RecordedBatch& batch, const afm_emulator::Checkpoint& recorded);
  void check_digest(const RecordedBatch& batch, const afm_emulator::Digest& recorded,
                    const std::optional<FieldDifference>& contradiction);
  void finish_epoch();

  RunLog log_;
  Batches batches_;
  RecordedDigest recorded_;
  Progress progress_;
  std::unique_ptr<Resimulation> simulation_;
  std::optional<std::uint32_t> epoch_, last_batch_;
  std::size_t next_checkpoint_ = 0;           // of the epoch
  std::optional<std::uint64_t> next_sample_;  // that the next batch should begin with
  ModelTime begin_, end_;                     // of what is compared, in this epoch
  Gaps unpublished_;
  std::optional<Difference> difference_;
  Extent extent_;
};

}  // namespace afm::replay
