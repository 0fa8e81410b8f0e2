// ROS's reader makes room for as many elements as a message says it holds before it checks whether they are there: many
// gigabytes for a damaged one. So lists are measured against their message first.
#pragma once

#include <afm_emulator/Checkpoint.h>
#include <afm_emulator/Deflection.h>
#include <afm_emulator/ImpactArray.h>
#include <ros/serialization.h>

#include <cstdint>
#include <cstring>
#include <vector>

#include "node/parameters/live_parameters.h"

namespace afm::replay {

// Walks over a message as it stands in a bag.
class Measure {
 public:
  explicit Measure(const std::vector<std::uint8_t>& bytes) : bytes_(bytes) {}

  void fixed(std::uint64_t size) { at_ += size; }
  void list(std::uint64_t element_size) {
    std::uint32_t count = 0;
    if (at_ + sizeof count <= bytes_.size()) std::memcpy(&count, bytes_.data() + at_, sizeof count);
    at_ += sizeof count + count * element_size;
  }
  bool fits() const { return at_ <= bytes_.size(); }

 private:
  const std::vector<std::uint8_t>& bytes_;
  std::uint64_t at_ = 0;
};

constexpr std::uint64_t kBeforeName = 12, kModelTime = 16;  // sequence number and stamp; tau and phase

template <class Message>
bool lengths_fit(const std::vector<std::uint8_t>&) {
  return true;  // no lists, or texts alone, which are measured by the reader
}

template <>
inline bool lengths_fit<afm_emulator::Deflection>(const std::vector<std::uint8_t>& bytes) {
  Measure measure(bytes);
  measure.fixed(kBeforeName);
  measure.list(1);
  measure.fixed(sizeof(std::uint32_t) + kModelTime + sizeof(std::uint64_t) + sizeof(double));
  measure.list(sizeof(double));
  measure.list(sizeof(double));
  return measure.fits();
}

template <>
inline bool lengths_fit<afm_emulator::ImpactArray>(const std::vector<std::uint8_t>& bytes) {
  Measure measure(bytes);
  measure.fixed(kBeforeName);
  measure.list(1);
  measure.fixed(sizeof(std::uint32_t) + sizeof(std::uint64_t));
  measure.list(ros::serialization::serializationLength(afm_emulator::Impact()));
  return measure.fits();
}

template <>
inline bool lengths_fit<afm_emulator::Checkpoint>(const std::vector<std::uint8_t>& bytes) {
  constexpr std::uint64_t kEpoch = 4, kWord = 8, kNumber = 4;
  constexpr std::uint64_t kInForce = 1 + sizeof(node::LiveParameters) / sizeof(double);  // drag velocity and the rest
  Measure measure(bytes);
  measure.fixed(kBeforeName);
  measure.list(1);
  measure.fixed(kEpoch + kModelTime + 3 * kWord + 2 * kNumber + kInForce * kWord + kBeforeName);
  measure.list(1);  // of the digests
  measure.fixed(kEpoch + kModelTime + 10 * kWord + kNumber);
  measure.list(kWord);
  return measure.fits();
}

}  // namespace afm::replay
