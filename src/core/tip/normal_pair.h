// Normally distributed random numbers as a function of a counter and a key, with the same bits on every machine.
#pragma once

#include <cmath>
#include <cstdint>

#include "afm/detail/turns.h"
#include "core/portable_exp.h"
#include "philox.h"

namespace afm::detail {

struct NormalPair {
  double first, second;
};

// A 53-bit number in (0, 1].
inline double unit(std::uint64_t bits) { return static_cast<double>((bits >> 11) + 1) * 0x1p-53; }

// The method of Box and Muller.
inline NormalPair normals_of(double radius, double angle) {
  const double r = std::sqrt(-2.0 * portable_log(radius));
  const SinCos<double> turn = sin_cos_turns(angle);
  return {r * turn.cos, r * turn.sin};
}

inline std::uint64_t joined(std::uint32_t low, std::uint32_t high) {
  return low | static_cast<std::uint64_t>(high) << 32;
}

// Two standard normal deviates; |xi| < 8.6, as the smallest uniform number is 2^-53.
inline NormalPair normal_pair(std::uint64_t seed, std::uint64_t stream, std::uint64_t index) {
  const PhiloxCounter counter = {low_word(index), high_word(index), low_word(stream), high_word(stream)};
  const PhiloxCounter random = philox4x32(counter, {low_word(seed), high_word(seed)});
  return normals_of(unit(joined(random[0], random[1])), unit(joined(random[2], random[3])));
}

}  // namespace afm::detail
