// What one epoch of a run is a function of, and the times of samples that follow from it.
#pragma once

#include <afm_emulator/Configuration.h>

#include <cstdint>
#include <set>
#include <vector>

#include "afm_emulator/sample_grid.h"
#include "applied.h"

namespace afm::replay {

struct EpochLog {
  afm_emulator::Configuration configuration;
  std::vector<afm_emulator::AppliedDrag> drags;          // the first at model time 0
  std::vector<afm_emulator::AppliedParameters>
      changes;  // likewise; none in bags of versions that could not change them
  std::vector<Applied> commands;                         // both, in the order in which they took effect
  std::set<std::uint64_t> stretches;  // samples with which digests begin anew, as those before were not taken

  ModelTime sample_time(std::uint64_t sample) const { return grid_of(sample).time_or_end(sample); }
  std::uint64_t most_samples_per_batch() const;

  // Merges the commands, and throws Problem if they cannot have been what ran.
  void put_in_order();

 private:
  SampleGrid grid_of(std::uint64_t sample) const;
  void check_drags() const;
  void check_changes();
  void check_levels() const;

  std::vector<SampleGrid> grids_;
};

}  // namespace afm::replay
