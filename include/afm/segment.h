// Segment records, the unit of the energy balance (paper, section III and Eq. 1; docs/algorithm.md, "Energy"). A
// segment lies within one phase of motion (flight, impact, chatter sequence, contact) and between two commands or kicks
// of the bath. A kick is a segment by itself. Guarantee: imbalance() is rounding.
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
  double impulse = 0.0;     // of the holder's lateral force on the tip [m_tip a/tau]
  // energy lost in impacts [m_tip a^2/tau^2]; below zero by a part of a bounce where a record of chatter began within
  // the bounce in which the sequence is cut
  double loss = 0.0;
  double heat = 0.0;        // given to the bath [m_tip a^2/tau^2]
  double stored = 0.0;      // change of the energy in springs and motion, in the lab [m_tip a^2/tau^2]
  std::uint64_t count = 0;  // impacts

  double work() const { return eta * impulse; }                       // of the drag [m_tip a^2/tau^2]
  double imbalance() const { return work() - loss - heat - stored; }  // zero except for rounding
};

// The records that one step of Tip::advance_segment() ends: a segment of motion, and the impact or kick at its end, or
// both.
class Segments {
 public:
  void clear() { size_ = 0; }
  void add(const Segment& segment) { segments_[size_++] = segment; }
  const Segment* begin() const { return segments_.data(); }
  const Segment* end() const { return segments_.data() + size_; }

 private:
  std::array<Segment, 3> segments_;
  std::size_t size_ = 0;
};

}  // namespace afm
