// Where recordings go: names of bags, and the room on their disk.
#pragma once

#include <cstdint>
#include <string>

namespace afm::node {

// What is wrong with a name that a user asks for, or nothing. A good one stays in its directory, and cannot be taken for
// another kind of file.
std::string find_name_fault(const std::string& name);

// directory/NAME without .bag; of an empty name afm_2024-05-31-12-00-00 (local time), or what follows if that is taken.
std::string bag_base(const std::string& directory, const std::string& name);

// Free on the disk on which the directory is, or would be made [bytes]; negative: unknown.
std::int64_t free_bytes(const std::string& directory);

}  // namespace afm::node
