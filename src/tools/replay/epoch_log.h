// What one epoch of a run is a function of, and the times of samples that follow from it.
#pragma once

#include <afm_emulator/Checkpoint.h>
#include <afm_emulator/Configuration.h>

#include <cstdint>
#include <optional>
#include <set>
#include <vector>

#include "afm/emulator.h"
#include "afm/detail/sample_grid.h"
#include "applied.h"
#include "node/wire/run_digest.h"

namespace afm::replay {

// What the recording holds of the first batch after its beginning; a checkpoint behind that is no beginning.
struct FirstBatch {
  std::uint32_t epoch = 0;
  std::uint64_t sample = 0, impact = 0;
  ModelTime end = kEndOfTime;
};

struct EpochLog {
  afm_emulator::Configuration configuration;
  std::vector<afm_emulator::Checkpoint> checkpoints;
  // From the beginning of the epoch on, or from the checkpoint that the recording begins with.
  std::vector<afm_emulator::AppliedDrag> drags;
  std::vector<afm_emulator::AppliedParameters> changes;  // none in bags of versions that could not change them
  std::vector<Applied> commands;                         // both, in the order in which they took effect
  std::set<std::uint64_t> stretches;  // samples with which digests begin anew, as those before were not taken

  ModelTime sample_time(std::uint64_t sample) const { return grid_of(sample).time_or_end(sample); }
  std::uint64_t most_samples_per_batch() const;

  // Chooses where to begin, merges the commands, and throws Problem if they cannot have been what ran.
  void put_in_order(const FirstBatch& first);

  const afm_emulator::Checkpoint* start() const { return start_ ? &*start_ : nullptr; }  // null: the epoch's beginning
  const Emulator& emulator() const { return *emulator_; }                                // there, like the next three
  node::Parameters parameters() const;
  node::RunDigest digest() const;
  double drag_velocity() const;  // [m/s]
  std::uint64_t commands_before() const { return start_ ? start_->digest.commands : 0; }
  std::uint64_t drags_before() const { return start_ ? start_->drags : 0; }

 private:
  bool reaches_back() const;
  void choose_start(const FirstBatch& first);
  void drop_before_start();
  void merge();
  SampleGrid grid_of(std::uint64_t sample) const;
  void check_drags() const;
  void check_changes();
  void check_levels() const;

  std::optional<afm_emulator::Checkpoint> start_;
  std::optional<Emulator> emulator_;
  std::vector<SampleGrid> grids_;
};

}  // namespace afm::replay
