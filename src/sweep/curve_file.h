// The table of a curve: a stream, or a file that an interrupted run goes on with. Beside the file lies FILE.settings:
// one line with all that the table depends on.
#pragma once

#include <cstddef>
#include <fstream>
#include <ostream>
#include <string>

#include "common/table_writer.h"
#include "grid.h"

namespace afm {

class CurveFile {
 public:
  // `path` "-" is standard output. Throws std::runtime_error where it cannot be written or belongs to other settings.
  CurveFile(const std::string& path, const CurveSettings& settings, const TableUnits& units);
  ~CurveFile();
  CurveFile(const CurveFile&) = delete;
  CurveFile& operator=(const CurveFile&) = delete;

  std::size_t rows() const { return rows_; }
  bool can_go_on() const { return lock_ >= 0; }
  void add(const SweepResult& result);  // the next row
  void flush();                         // throws std::runtime_error

 private:
  void claim(const std::string& identity);
  void keep_whole_chains(const TableUnits& units);

  const std::string path_;
  const CurveSettings& settings_;
  int lock_ = -1;  // FILE.settings, which one run at a time may hold
  std::size_t rows_ = 0;
  std::ofstream file_;
  std::ostream& out_;
  TableWriter writer_;
};

}  // namespace afm
