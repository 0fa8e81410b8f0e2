#include "curve_table.h"

#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <iostream>
#include <stdexcept>

#include "rows.h"

namespace afm {
CurveTable::CurveTable(const std::string& path, const SweepGrid& grid, const TableUnits& units)
    : path_(path), grid_(grid), out_(path == "-" ? std::cout : file_), writer_(out_, curve_columns(), units) {
  errno = 0;
  if (path != "-") open();
  writer_.write_header();
  flush();
}

// A table that is there is written over, never emptied: one that is empty would be taken for the beginning of a new
// run.
void CurveTable::open() {
  file_.open(path_, std::ios::binary | std::ios::in | std::ios::out);
  if (!file_.is_open()) file_.open(path_, std::ios::binary | std::ios::trunc);
}

void CurveTable::cut() {
  flush();
  const std::streamoff length = file_.is_open() ? static_cast<std::streamoff>(file_.tellp()) : -1;
  if (length >= 0) (void)!::truncate(path_.c_str(), length);  // fails for what is no file
}

void CurveTable::add(std::size_t position, const SweepResult& result) {
  waiting_[position] = result;
  for (auto next = waiting_.begin(); next != waiting_.end() && next->first == rows_; next = waiting_.erase(next)) {
    write_row(grid_.at(rows_), next->second, writer_);
    ++rows_;
  }
}

void CurveTable::flush() {
  if (out_.flush()) return;
  throw std::runtime_error("cannot write " + path_ + (errno != 0 ? std::string(": ") + std::strerror(errno) : ""));
}

}  // namespace afm
