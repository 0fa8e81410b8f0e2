#include "progress_bar.h"

#include <unistd.h>

#include <cstdio>
#include <string>

namespace afm {
namespace {

std::string time_text(double seconds) {
  const long s = static_cast<long>(seconds + 0.5);
  char text[32];
  if (s < 3600) {
    std::snprintf(text, sizeof text, "%ld:%02ld", s / 60, s % 60);
  } else {
    std::snprintf(text, sizeof text, "%ld:%02ld:%02ld", s / 3600, s / 60 % 60, s % 60);
  }
  return text;
}

}  // namespace

ProgressBar::ProgressBar(std::size_t total, std::size_t before, const char* unit)
    : terminal_(::isatty(STDERR_FILENO) == 1), total_(total), before_(before), unit_(unit), begin_(Clock::now()) {
  show(before);
}

ProgressBar::~ProgressBar() {
  if (terminal_) std::fputs("\n", stderr);
}

void ProgressBar::show(std::size_t done) {
  constexpr std::size_t kWidth = 40;
  constexpr std::chrono::milliseconds kPause(200);
  const Clock::time_point now = Clock::now();
  if (!terminal_ || (done < total_ && done > before_ && now - shown_ < kPause)) return;
  shown_ = now;
  const double spent = std::chrono::duration<double>(now - begin_).count();
  const std::size_t full = total_ > 0 ? kWidth * done / total_ : kWidth;
  std::string line = "\r[" + std::string(full, '#') + std::string(kWidth - full, '.') + "] " + std::to_string(done) +
                     "/" + std::to_string(total_) + " " + unit_ + ", " + time_text(spent);
  if (done > before_ && done < total_) {
    line += ", left " + time_text(spent * static_cast<double>(total_ - done) / static_cast<double>(done - before_));
  }
  std::fputs((line + "   ").c_str(), stderr);
}

}  // namespace afm
