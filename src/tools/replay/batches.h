// The batches of a recording: deflection, impacts and friction that were published together, joined by their sequence
// numbers, whatever their order among each other in the bag.
#pragma once

#include <afm_emulator/Deflection.h>
#include <afm_emulator/Digest.h>
#include <afm_emulator/Friction.h>
#include <afm_emulator/ImpactArray.h>

#include <algorithm>
#include <cstdint>
#include <optional>
#include <string>

#include "message_stream.h"
#include "recording.h"

namespace afm::replay {

// A part that the recording does not hold is null.
struct RecordedBatch {
  boost::shared_ptr<const afm_emulator::Deflection> deflection;
  boost::shared_ptr<const afm_emulator::ImpactArray> impacts;
  boost::shared_ptr<const afm_emulator::Friction> friction;
  std::uint32_t sequence = 0, epoch = 0;

  bool is_whole() const { return deflection && impacts && friction; }
};

inline std::uint64_t end_of(const afm_emulator::Deflection& batch) {
  return batch.first_sample + batch.vertical.size();
}
inline std::uint64_t end_of(const afm_emulator::ImpactArray& batch) { return batch.first_index + batch.impacts.size(); }

// Messages missing inside the recording; at its ends a batch may be cut.
struct Gaps {
  std::uint64_t messages = 0;
  std::string first;  // where, for people
};

class Batches {
 public:
  explicit Batches(const Recording& recording);

  // False at the end. Throws Problem when messages are out of order, or nothing is there at all.
  bool next(RecordedBatch& batch);
  const afm_emulator::Deflection* next_deflection() const {
    return deflection_.head();
  }  // of a later batch; null at the end
  const Gaps& gaps() const { return gaps_; }
  std::uint64_t read() const { return read_; }
  std::uint64_t size() const { return size_; }  // about how many there are to read

 private:
  void note_gap(std::uint64_t messages, std::uint32_t before);
  void note_cuts(bool at_end);

  MessageStream<afm_emulator::Deflection> deflection_;
  MessageStream<afm_emulator::ImpactArray> impacts_;
  MessageStream<afm_emulator::Friction> friction_;
  std::optional<RecordedBatch> last_;
  Gaps gaps_;
  std::uint64_t read_ = 0, size_ = 0;
};

}  // namespace afm::replay
