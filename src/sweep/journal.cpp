#include "journal.h"

#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <stdexcept>
#include <vector>

#include "common/csv.h"

namespace afm {
namespace {

constexpr char kTitle[] = "# friction_curve ";

// Without the line that a kill cut short.
std::vector<std::string> whole_lines(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::vector<std::string> lines;
  std::string line;
  while (std::getline(file, line) && !file.eof()) lines.push_back(line);
  return lines;
}

bool parse_record(const std::string& line, std::size_t& position, PackedResult& result) {
  const std::vector<std::string> fields = split_fields(line);
  double number = 0.0;
  if (fields.size() != result.size() + 1 || !parse_number(fields[0], number) || !(number >= 0.0)) return false;
  position = static_cast<std::size_t>(number);
  for (std::size_t i = 0; i < result.size(); ++i) {
    if (!parse_number(fields[i + 1], result[i])) return false;
  }
  return true;
}

}  // namespace

Journal::Journal(const std::string& path, const std::string& identity, bool begin_again)
    : path_(path), file_(std::fopen(path.c_str(), "a")) {
  if (file_ == nullptr) throw std::runtime_error("cannot open " + path + ": " + std::strerror(errno));
  try {
    lock();
    if (begin_again && ::ftruncate(::fileno(file_), 0) != 0) throw std::runtime_error("cannot empty " + path);
    read(identity);
  } catch (...) {
    std::fclose(file_);
    throw;
  }
}

Journal::~Journal() { std::fclose(file_); }

void Journal::lock() {
  if (::flock(::fileno(file_), LOCK_EX | LOCK_NB) == 0) return;
  throw std::runtime_error(path_ + " is being written by another run");
}

void Journal::read(const std::string& identity) {
  const std::vector<std::string> lines = whole_lines(path_);
  off_t good = 0;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    std::size_t position = 0;
    PackedResult result{};
    if (i == 0) {
      if (lines[0] == kTitle + identity) {
        good += static_cast<off_t>(lines[0].size() + 1);
        continue;
      }
      throw std::runtime_error("it belongs to other settings.\n  there: " + lines[0].substr(std::strlen(kTitle)) +
                               "\n  asked: " + identity);
    }
    if (!parse_record(lines[i], position, result)) {
      throw std::runtime_error(path_ + ":" + std::to_string(i + 1) + " is damaged");
    }
    found_[position] = result;
    good += static_cast<off_t>(lines[i].size() + 1);
  }
  if (::ftruncate(::fileno(file_), good) != 0) throw std::runtime_error("cannot write " + path_);
  if (lines.empty()) write(kTitle + identity + "\n");
}

void Journal::append(std::size_t position, const PackedResult& result) {
  std::vector<double> row{static_cast<double>(position)};
  row.insert(row.end(), result.begin(), result.end());
  write(join_numbers(row) + "\n");
}

void Journal::write(const std::string& text) {
  if (std::fputs(text.c_str(), file_) >= 0 && std::fflush(file_) == 0) return;
  throw std::runtime_error("cannot write " + path_ + ": " + std::strerror(errno));
}

}  // namespace afm
