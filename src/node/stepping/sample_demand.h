// Whether anyone wants samples of the deflection. The publishing thread sets it; the stepping thread reads it before each
// batch, and neither waits for the other.
#pragma once

#include <atomic>
#include <cstdint>

namespace afm::node {

class SampleDemand {
 public:
  // One thread at a time.
  void want(bool wanted) {
    if (wanted == (stretch_ != 0)) return;
    stretch_ = wanted ? ++latest_ : 0;
  }

  // The number of the present stretch of samples; 0: nobody wants any. Batches of one stretch follow each other without
  // a gap, so that whoever is given one stretch alone misses nothing in it.
  std::uint32_t stretch() const { return stretch_; }

 private:
  std::atomic<std::uint32_t> stretch_{0};
  std::uint32_t latest_ = 0;
};

}  // namespace afm::node
