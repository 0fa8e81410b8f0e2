// How much is free where recordings go, asked now and then by a thread that may wait for a disk, read by one that may
// not.
#pragma once

#include <atomic>
#include <cstdint>
#include <string>

namespace afm::node {

class DiskSpace {
 public:
  explicit DiskSpace(const std::string& directory);  // need not be there yet

  void measure();                             // may wait for the disk
  std::int64_t free_bytes() const { return free_; }  // as last measured; negative: unknown

 private:
  const std::string directory_;
  std::atomic<std::int64_t> free_{-1};
};

}  // namespace afm::node
