// How far one step may go: what is emulated and published within seconds.
#pragma once

#include <cstdint>

namespace afm::node {

constexpr double kMaxStepTau = 1e4;  // 1.6 s of model time at the paper's frequency
constexpr std::uint64_t kMaxStepImpacts = 100000;

}  // namespace afm::node
