// Lobatto's method of order 8: its five points are the start of the step and four nodes, the last at its end.
#pragma once

#include <cstddef>

namespace afm::detail {

constexpr double kRoot21 = 4.58257569495584;
constexpr std::size_t kNodeCount = 4;
constexpr double kNodes[4] = {0.5 - kRoot21 / 14, 0.5, 0.5 + kRoot21 / 14, 1.0};

// kLobatto[k][i]: weight of the rate at point k in the integral from the start to node i.
constexpr double kLobatto[5][4] = {
    {(119 + 3 * kRoot21) / 1960, 13.0 / 320, (119 - 3 * kRoot21) / 1960, 1.0 / 20},
    {(343 - 9 * kRoot21) / 2520, (392 + 105 * kRoot21) / 2880, (343 + 69 * kRoot21) / 2520, 49.0 / 180},
    {(392 - 96 * kRoot21) / 2205, 8.0 / 45, (392 + 96 * kRoot21) / 2205, 16.0 / 45},
    {(343 - 69 * kRoot21) / 2520, (392 - 105 * kRoot21) / 2880, (343 + 9 * kRoot21) / 2520, 49.0 / 180},
    {(-21 + 3 * kRoot21) / 1960, 3.0 / 320, (-21 - 3 * kRoot21) / 1960, 1.0 / 20}};

}  // namespace afm::detail
