// Refused commands and parameters, with the reason: counted, and the latest kept. Any thread.
#pragma once

#include <chrono>
#include <cstdint>
#include <mutex>
#include <string>

namespace afm::node {

enum class Refusal { faulty_command, overload, faulty_change };

class Refusals {
 public:
  struct Summary {
    std::uint64_t commands = 0, changes = 0;
    // the latest
    Refusal kind = Refusal::faulty_command;
    std::string reason;  // empty: nothing was refused
    std::chrono::steady_clock::time_point when;
  };

  void add(Refusal kind, const std::string& reason) {
    const std::lock_guard<std::mutex> lock(mutex_);
    ++(kind == Refusal::faulty_change ? summary_.changes : summary_.commands);
    summary_.kind = kind;
    summary_.reason = reason;
    summary_.when = std::chrono::steady_clock::now();
  }
  Summary summary() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return summary_;
  }

 private:
  mutable std::mutex mutex_;
  Summary summary_;
};

}  // namespace afm::node
