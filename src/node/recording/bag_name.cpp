#include "bag_name.h"

#include <cstdlib>

namespace afm::node {
namespace {

constexpr std::size_t kMaxLength = 200;  // file systems take 255 bytes, and endings are added
const std::string kEnding = ".bag";
const std::string kLetters = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ";
const std::string kDigits = "0123456789";

bool ends_with(const std::string& text, const std::string& ending) {
  return text.size() >= ending.size() && text.compare(text.size() - ending.size(), ending.size(), ending) == 0;
}

bool is_any_of(char c, const std::string& set) { return set.find(c) != std::string::npos; }

}  // namespace

std::string find_name_fault(const std::string& name) {
  if (name.find('/') != std::string::npos) return "must not contain a path: bags are written to bag_directory";
  if (name.size() > kMaxLength) return "must have at most " + std::to_string(kMaxLength) + " characters";
  if (name.find_first_not_of(kLetters + kDigits + "_.+-") != std::string::npos) {
    return "must be of letters, digits and _ . + - only";
  }
  if (name.empty() || !is_any_of(name.front(), kLetters + kDigits)) return "must begin with a letter or digit";
  if (!is_any_of(name.back(), kLetters + kDigits)) return "must end with a letter or digit";
  if (ends_with(name, ".active")) return "must not end with .active: such a bag is being written";
  return {};
}

std::string with_bag_ending(const std::string& name) { return without_bag_ending(name) + kEnding; }

std::string without_bag_ending(const std::string& name) {
  return ends_with(name, kEnding) ? name.substr(0, name.size() - kEnding.size()) : name;
}

std::string name_from_time(std::time_t time) {
  std::tm local{};
  localtime_r(&time, &local);
  char text[64];
  std::strftime(text, sizeof text, "afm_%Y-%m-%d-%H-%M-%S", &local);
  return text;
}

std::string expand_home(const std::string& path) {
  const char* home = std::getenv("HOME");
  if (home == nullptr || path.empty() || path[0] != '~' || (path.size() > 1 && path[1] != '/')) return path;
  return home + path.substr(1);
}

}  // namespace afm::node
