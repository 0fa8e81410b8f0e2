// The complete state of a run in 64-bit words: what is restored from it goes on to the same bits. Doubles by their
// bits, whole numbers as they are, so that it is the same on every machine.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace afm {

// What the words mean, and how many there are; a state of another layout cannot be restored.
std::uint32_t state_layout();

struct SavedState {
  static constexpr std::size_t kMostWords = 512;

  const std::uint64_t* begin() const { return words.data(); }
  const std::uint64_t* end() const { return words.data() + size; }

  std::array<std::uint64_t, kMostWords> words{};
  std::size_t size = 0;
};

}  // namespace afm
