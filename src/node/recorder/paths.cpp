#include "paths.h"

#include <ctime>
#include <filesystem>
#include <regex>

namespace afm::node {

namespace fs = std::filesystem;

std::string find_name_fault(const std::string& name) {
  constexpr std::size_t kMaxLength = 200;  // file systems take 255 bytes, and endings are added
  static const std::regex good("[A-Za-z0-9]([A-Za-z0-9_.+-]*[A-Za-z0-9])?"), active(".*\\.active");
  if (name.find('/') != std::string::npos) return "must not contain a path: bags are written to bag_directory";
  if (name.size() > kMaxLength) return "must have at most " + std::to_string(kMaxLength) + " characters";
  if (std::regex_match(name, active)) return "must not end with .active: such a bag is being written";
  if (std::regex_match(name, good)) return {};
  return "must be of letters, digits and _ . + - only, and begin and end with a letter or digit";
}

std::string bag_base(const std::string& directory, const std::string& name) {
  const fs::path place = fs::absolute(directory);
  if (!name.empty()) return place / std::regex_replace(name, std::regex("\\.bag$"), "");
  const std::time_t now = std::time(nullptr);
  std::tm local{};
  localtime_r(&now, &local);
  char text[64];
  std::strftime(text, sizeof text, "afm_%Y-%m-%d-%H-%M-%S", &local);
  const std::string base = place / text;
  const auto is_taken = [](const std::string& path) { return fs::exists(path + ".bag") || fs::exists(path + ".bag.active"); };
  std::string free = base;
  for (int i = 1; is_taken(free); ++i) free = base + "-" + std::to_string(i);
  return free;
}

std::int64_t free_bytes(const std::string& directory) {
  std::error_code error;
  for (fs::path path = fs::absolute(directory, error); !error; path = path.parent_path()) {
    const fs::space_info room = fs::space(path, error);
    if (!error) return static_cast<std::int64_t>(room.available);
    if (!path.has_relative_path()) break;
    error.clear();
  }
  return -1;
}

}  // namespace afm::node
