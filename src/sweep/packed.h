// A result as plain numbers: what goes into journals and messages.
#pragma once

#include <array>
#include <cstddef>

#include "afm/dynamics/sweep.h"

namespace afm {

constexpr std::size_t kPackedState = 5;
constexpr std::size_t kPackedNumbers = 12 + kPackedState;

using PackedState = std::array<double, kPackedState>;
using PackedResult = std::array<double, kPackedNumbers>;

PackedState pack(const TipState& state);
TipState unpack(const PackedState& numbers);
PackedResult pack(const SweepResult& result);
SweepResult unpack(const PackedResult& numbers);

}  // namespace afm
