#include "bag_file.h"

#include <fcntl.h>
#include <malloc.h>
#include <stdio.h>
#include <sys/stat.h>
#include <sys/statvfs.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <vector>

namespace afm::node {
namespace {

// rosbag writes a chunk when it is full: one may be under way, and its index follows it
constexpr std::uint64_t kChunkSlack = 2 * 1024 * 1024;
constexpr std::uint64_t kBetweenChecks = 256 * 1024;  // [bytes] a choice: a system call for each quarter of a megabyte
// a second of an ordinary run: with less room a recording is not begun
constexpr std::uint64_t kLeastRecording = 4 * 1024 * 1024;

bool exists(const std::string& path) {
  struct stat status {};
  return lstat(path.c_str(), &status) == 0;
}

// Takes the name for us alone; rosbag then opens a file that is there.
void create_exclusively(const std::string& path) {
  const int file = open(path.c_str(), O_CREAT | O_EXCL | O_WRONLY | O_CLOEXEC, 0644);
  if (file < 0) throw std::runtime_error(path + ": " + std::strerror(errno));
  ::close(file);
}

// Not every file system can refuse to overwrite while renaming; there we check first.
bool rename_without_overwriting(const std::string& from, const std::string& to) {
  if (renameat2(AT_FDCWD, from.c_str(), AT_FDCWD, to.c_str(), RENAME_NOREPLACE) == 0) return true;
  if (errno != EINVAL && errno != ENOSYS) return false;
  return !exists(to) && std::rename(from.c_str(), to.c_str()) == 0;
}

}  // namespace

BagFile::BagFile(const std::string& path, std::uint64_t reserve_bytes, rosbag::CompressionType compression)
    : path_(path), active_path_(path + ".active"), reserve_bytes_(reserve_bytes) {
  if (exists(path_)) throw std::runtime_error(path_ + ": there is such a bag already");
  create_exclusively(active_path_);
  const std::string trouble = ask_disk(kLeastRecording);
  if (!trouble.empty()) {
    unlink(active_path_.c_str());
    throw std::runtime_error(path_ + ": " + trouble);
  }
  auto bag = std::make_unique<rosbag::Bag>();
  try {
    bag->open(active_path_, rosbag::bagmode::Write);
  } catch (const std::exception&) {
    unlink(active_path_.c_str());
    throw;
  }
  bag->setCompression(compression);
  bag_ = std::move(bag);
}

BagFile::~BagFile() { close(); }

std::string BagFile::ask_disk(std::uint64_t bytes) const {
  struct statvfs disk {};
  if (statvfs(active_path_.c_str(), &disk) != 0) return active_path_ + ": " + std::strerror(errno);
  if (disk.f_bavail * disk.f_frsize >= reserve_bytes_ + kChunkSlack + bytes) return {};
  return "the disk is full but for the " + std::to_string(reserve_bytes_ / 1000000) +
         " MB that stay free (disk_reserve_mb)";
}

std::string BagFile::check_space(std::uint64_t bytes) {
  if (bytes_allowed_ < bytes) {
    const std::string trouble = ask_disk(bytes + kBetweenChecks);
    if (!trouble.empty()) return trouble;
    bytes_allowed_ = bytes + kBetweenChecks;
  }
  bytes_allowed_ -= bytes;
  return {};
}

std::string BagFile::close() {
  if (!bag_) return {};
  try {
    bag_->close();
  } catch (const std::exception& error) {
    // The destructor would try again, throw again, and end the process: the bag is kept until the process ends instead.
    static auto& abandoned = *new std::vector<rosbag::Bag*>;
    abandoned.push_back(bag_.release());
    return std::string("closing it failed (") + error.what() + "): rosbag reindex " + active_path_ +
           " recovers what is in it";
  }
  bag_.reset();
  if (messages_ == 0) {
    unlink(active_path_.c_str());
    return {};
  }
  malloc_trim(0);  // what waited for a slow disk has left holes all over the heap
  if (rename_without_overwriting(active_path_, path_)) return {};
  return active_path_ + " is closed but could not be renamed: " + std::strerror(errno);
}

}  // namespace afm::node
