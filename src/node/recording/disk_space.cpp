#include "disk_space.h"

#include <sys/statvfs.h>

#include <filesystem>

#include "bag_name.h"

namespace afm::node {

DiskSpace::DiskSpace(const std::string& directory) : directory_(expand_home(directory)) {}

// Of the disk on which the directory is, or would be made.
void DiskSpace::measure() {
  std::error_code error;
  std::filesystem::path path = std::filesystem::absolute(directory_, error);
  struct statvfs disk {};
  while (statvfs(path.c_str(), &disk) != 0) {
    if (!path.has_relative_path()) {
      free_ = -1;
      return;
    }
    path = path.parent_path();
  }
  free_ = static_cast<std::int64_t>(disk.f_bavail * disk.f_frsize);
}

}  // namespace afm::node
