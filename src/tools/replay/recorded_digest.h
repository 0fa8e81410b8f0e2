// Whether a recording is what was published: its messages against the digests that were recorded with them. Needs no
// simulation.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "message_difference.h"
#include "node/run_digest.h"
#include "run_log.h"

namespace afm::replay {

class RecordedDigest {
 public:
  explicit RecordedDigest(const RunLog& log) : log_(log) {}

  void begin(std::uint32_t epoch);  // from its beginning on, if nothing else is said
  // In the order of batches.
  template <class Message>
  void add(const Message& batch) {
    begin(batch.epoch);
    digest_.add(batch);
  }
  void gap() { whole_ = false; }  // something is missing: nothing can be said up to the next digest

  // A digest that stands after all that was added. Returns where what was recorded differs from it.
  std::optional<FieldDifference> check(const afm_emulator::Digest& told);

  std::uint64_t checked() const { return checked_; }  // digests

 private:
  const RunLog& log_;
  node::RunDigest digest_;
  std::optional<std::uint32_t> epoch_;
  bool whole_ = false;  // nothing is missing since the last digest, or the beginning of the epoch
  std::uint64_t checked_ = 0;
};

}  // namespace afm::replay
