// Where a bag ends by its own account. rosbag's reader never reads beyond it: of two bags in one file it reads the
// first.
#pragma once

#include <cstdint>
#include <string>

namespace afm::replay {

// How many bytes stand behind the index of a bag that has one.
std::uint64_t bytes_behind(const std::string& path);

}  // namespace afm::replay
