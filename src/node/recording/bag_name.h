// Names of bags: what a user may ask for, what we choose.
#pragma once

#include <ctime>
#include <string>

namespace afm::node {

// What is wrong with a name, or nothing. A good one stays in its directory and cannot be taken for another kind of
// file.
std::string find_name_fault(const std::string& name);

std::string with_bag_ending(const std::string& name);     // NAME and NAME.bag: NAME.bag
std::string without_bag_ending(const std::string& name);  // NAME
std::string name_from_time(std::time_t time);             // afm_2024-05-31-12-00-00, local time
std::string expand_home(const std::string& path);         // a leading ~/

}  // namespace afm::node
