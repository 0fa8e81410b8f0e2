// How far long work has come and how long it will take, on one line of a terminal.
#pragma once

#include <chrono>
#include <cstddef>

namespace afm {

class ProgressBar {
 public:
  // Silent where stderr is no terminal. `before`: done by an earlier run, which says nothing about the speed of this
  // one.
  ProgressBar(std::size_t total, std::size_t before, const char* unit = "points");
  ~ProgressBar();

  void show(std::size_t done);

 private:
  using Clock = std::chrono::steady_clock;
  bool terminal_;
  std::size_t total_, before_;
  const char* unit_;
  Clock::time_point begin_, shown_;
};

}  // namespace afm
