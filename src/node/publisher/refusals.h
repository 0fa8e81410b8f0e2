// What was asked of the node and refused, and why: counted, and the latest kept. Any thread.
#pragma once

#include <chrono>
#include <cstdint>
#include <mutex>
#include <optional>
#include <string>

namespace afm::node {

enum class Refusal { faulty_command, overload, faulty_change };

class Refusals {
 public:
  struct Latest {
    Refusal kind;
    std::string text;
    std::chrono::steady_clock::time_point when;
  };

  void add(Refusal kind, std::string text) {
    const std::lock_guard<std::mutex> lock(mutex_);
    ++(kind == Refusal::faulty_change ? changes_ : commands_);
    latest_ = Latest{kind, std::move(text), std::chrono::steady_clock::now()};
  }
  std::uint64_t commands() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return commands_;
  }
  std::uint64_t changes() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return changes_;
  }
  std::optional<Latest> latest() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return latest_;
  }

 private:
  mutable std::mutex mutex_;
  std::uint64_t commands_ = 0, changes_ = 0;
  std::optional<Latest> latest_;
};

}  // namespace afm::node
