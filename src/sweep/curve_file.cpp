#include "curve_file.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <iostream>
#include <iterator>
#include <sstream>
#include <stdexcept>

#include "afm/number_text.h"
#include "common/csv.h"
#include "rows.h"

namespace afm {
namespace {

std::runtime_error cannot(const std::string& verb, const std::string& path) {
  return std::runtime_error("cannot " + verb + " " + path +
                            (errno != 0 ? std::string(": ") + std::strerror(errno) : ""));
}

std::runtime_error taken(const std::string& reason) {
  return std::runtime_error(reason + "\n  (choose another name, or remove it to begin again)");
}

bool is_stream(const std::string& path) {
  struct stat status {};
  return path == "-" || (::stat(path.c_str(), &status) == 0 && !S_ISREG(status.st_mode));
}

bool has_content(const std::string& path) {
  struct stat status {};
  return ::stat(path.c_str(), &status) == 0 && status.st_size > 0;
}

// The same natural numbers are another table in other units.
std::string with_units(const std::string& identity, const TableUnits& units) {
  std::string text = identity + " units=";
  for (const Quantity q : {Quantity::length, Quantity::time, Quantity::energy})
    text += number_text(units.convert(q, 1.0)) + "/";
  return text;
}

// Are the rows those of one point, whatever was found there?
bool are_of_one_point(const std::string& a, const std::string& b) {
  constexpr std::size_t kOfThePoint[] = {0, 1, 2, 10, 11, 12};  // of kCurveColumns
  const std::vector<std::string> one = split_fields(a), other = split_fields(b);
  return one.size() == other.size() && std::all_of(std::begin(kOfThePoint), std::end(kOfThePoint),
                                                   [&](std::size_t column) { return one[column] == other[column]; });
}

}  // namespace

CurveFile::CurveFile(const std::string& path, const CurveSettings& settings, const TableUnits& units)
    : path_(path), settings_(settings), out_(path == "-" ? std::cout : file_), writer_(out_, kCurveColumns, units) {
  if (path.empty()) throw std::runtime_error("must not be empty");
  errno = 0;
  if (!is_stream(path)) {
    claim(with_units(identity(settings), units));
    keep_whole_chains(units);
  }
  if (path != "-") file_.open(path, std::ios::binary | std::ios::app);
  if (path == "-" || !has_content(path)) writer_.write_header();
  flush();
}

CurveFile::~CurveFile() {
  if (lock_ >= 0) ::close(lock_);
}

// The settings are written before the table: a table without them is none of ours.
void CurveFile::claim(const std::string& identity) {
  const std::string path = path_ + ".settings";
  if (has_content(path_) && !has_content(path)) {
    throw taken("it is there already, without " + path + ", which says what it was made with");
  }
  lock_ = ::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
  if (lock_ < 0) throw cannot("open", path);
  if (::flock(lock_, LOCK_EX | LOCK_NB) != 0) throw std::runtime_error(path + " is being used by another run");
  if (!has_content(path_)) {  // another run may have begun and ended before the lock was ours
    std::ofstream file(path, std::ios::binary | std::ios::trunc);
    if (!(file << identity << '\n' << std::flush)) throw cannot("write", path);
    return;
  }
  std::string there;
  std::ifstream file(path);
  std::getline(file, there);
  if (there != identity) {
    throw taken("it belongs to other settings.\n  there: " + there + "\n  asked: " + identity);
  }
}

// Cuts off the line that a kill cut short, and the rows of a chain that was not finished: where the next point of it
// would begin is not in the table. The rows before must be those of the points.
void CurveFile::keep_whole_chains(const TableUnits& units) {
  const std::string header = units.header(kCurveColumns);
  std::ostringstream expected;
  TableWriter writer(expected, kCurveColumns, units);
  std::ifstream file(path_, std::ios::binary);
  std::string line;
  std::size_t lines = 0;
  off_t size = 0, kept = 0;
  while (std::getline(file, line) && !file.eof()) {
    if (lines == 0 && line != header) throw taken("it has other columns");
    if (lines > settings_.size()) throw taken("it has more rows than points");
    if (lines > 0) {
      expected.str("");
      write_row(settings_.at(lines - 1), {}, writer);
      if (!are_of_one_point(expected.str(), line)) {
        throw taken("line " + std::to_string(lines + 1) + " is not the row of its point");
      }
    }
    size += static_cast<off_t>(line.size() + 1);
    if (lines++ % settings_.chain_length() != 0) continue;
    kept = size;
    rows_ = lines - 1;
  }
  if (has_content(path_) && ::truncate(path_.c_str(), kept) != 0) throw cannot("write", path_);
}

void CurveFile::add(const SweepResult& result) { write_row(settings_.at(rows_++), result, writer_); }

void CurveFile::flush() {
  if (!out_.flush()) throw cannot("write", path_ == "-" ? "the standard output" : path_);
}

}  // namespace afm
