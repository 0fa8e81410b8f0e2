// A table with units, written row by row: 17 digits, so that each double comes back as the same bits.
#pragma once

#include <ostream>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "table_units.h"

namespace afm {

class TableWriter {
 public:
  TableWriter(std::ostream& out, std::vector<Column> columns, TableUnits units)
      : out_(out), columns_(std::move(columns)), units_(std::move(units)) {}
  TableWriter(std::ostream& out, const std::string& header);  // of columns without units

  void write_header() { out_ << units_.header(columns_) << '\n'; }

  // The cells of a row from left to right; only doubles have units.
  TableWriter& operator<<(double value);
  TableWriter& operator<<(const std::string& text);
  template <class Whole, class = std::enable_if_t<std::is_integral<Whole>::value>>
  TableWriter& operator<<(Whole value) {
    return *this << std::to_string(value);
  }
  void end_row();  // throws std::logic_error where the row has not a cell for every column
  void flush();    // throws std::runtime_error where what was written does not arrive

 private:
  std::ostream& out_;
  std::vector<Column> columns_;
  TableUnits units_;
  std::string row_;
  std::size_t cells_ = 0;
};

// Throws std::runtime_error if the file could not be written: to be known before a search of hours. What it holds
// stays. An empty path is no file.
void check_writable(const std::string& path);

}  // namespace afm
