// The unit of account: what one stretch of the motion costs and stores. A segment lies within one phase of the motion
// (flight, impact, chatter sequence, contact) and between two commands or kicks of the bath; a kick is one by itself. Natural units; the balance is that of Eq. 1-3.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "state.h"

namespace afm {

enum class SegmentKind : std::uint8_t { flight, impact, chatter, contact, kick };

struct Segment {
  SegmentKind kind = SegmentKind::flight;
  ModelTime begin, end;     // equal for an impact and a kick
  double eta = 0.0;         // drag velocity throughout [a/tau]
  double impulse = 0.0;     // of the holder's lateral force on the tip [m a/tau]
  double loss = 0.0;        // energy lost in impacts [m a^2/tau^2]
  double heat = 0.0;        // given to the bath [m a^2/tau^2]
  double stored = 0.0;      // change of the energy in springs and motion, in the lab [m a^2/tau^2]
  std::uint64_t count = 0;  // impacts

  double work() const { return eta * impulse; }                       // of the drag [m a^2/tau^2]
  double imbalance() const { return work() - loss - heat - stored; }  // zero but for rounding
};

// What one step of Tip::advance_arc() ends: an arc of the motion, and the impact or kick that ends it.
class Segments {
 public:
  void clear() { size_ = 0; }
  void add(const Segment& segment) { segments_[size_++] = segment; }
  const Segment* begin() const { return segments_.data(); }
  const Segment* end() const { return segments_.data() + size_; }

 private:
  std::array<Segment, 2> segments_;
  std::size_t size_ = 0;
};

// Totals since an arc or a chatter sequence began; `energy`: stored at `time`.
struct Account {
  ModelTime time;
  double impulse = 0.0, loss = 0.0, energy = 0.0;
  std::uint64_t count = 0;
};

}  // namespace afm
