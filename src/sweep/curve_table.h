// The table of a curve as a file: the rows in order, as far as they are known without a gap.
#pragma once

#include <cstddef>
#include <fstream>
#include <map>
#include <ostream>
#include <string>

#include "common/table_writer.h"
#include "grid.h"
#include "packed.h"

namespace afm {

class CurveTable {
 public:
  // Throws std::runtime_error where it cannot be written.
  CurveTable(const std::string& path, const SweepGrid& grid, const TableUnits& units);

  void add(std::size_t position, const SweepResult& result);
  void flush();  // throws std::runtime_error
  void cut();    // what an earlier run wrote beyond this
  std::size_t done() const { return rows_ + waiting_.size(); }

 private:
  void open();
  std::string path_;
  const SweepGrid& grid_;
  std::ofstream file_;
  std::ostream& out_;
  TableWriter writer_;
  std::size_t rows_ = 0;                        // written
  std::map<std::size_t, SweepResult> waiting_;  // for rows before them
};

}  // namespace afm
