// The complete state of a run in 64-bit words. Guarantee: a run that is restored from it goes on with the same bits, on
// every machine. Doubles are stored by their bits, integers by their value.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace afm {

// Identifies the meaning and the number of the words. A state of another layout cannot be restored.
std::uint32_t state_layout();

struct SavedState {
  static constexpr std::size_t kMaxWords = 512;  // room: Emulator::save() checks at compile time that it is enough

  const std::uint64_t* begin() const { return words.data(); }
  const std::uint64_t* end() const { return words.data() + size; }

  std::array<std::uint64_t, kMaxWords> words{};
  std::size_t size = 0;
};

}  // namespace afm
