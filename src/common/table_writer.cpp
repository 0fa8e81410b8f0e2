#include "table_writer.h"

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <stdexcept>

#include "csv.h"

namespace afm {

TableWriter::TableWriter(std::ostream& out, const std::string& header) : out_(out), units_(TableUnits::plain()) {
  for (const std::string& name : split_fields(header)) columns_.push_back({name});
}

TableWriter& TableWriter::operator<<(double value) {
  if (cells_ >= columns_.size()) throw std::logic_error("a row has more cells than the table has columns");
  constexpr int kDigits = 17;
  char text[32];
  const double number = units_.convert(columns_[cells_].quantity, value);
  const double shown = std::isnan(number) ? std::fabs(number) : number;  // without the sign that arithmetic gave a nan
  const int length = std::snprintf(text, sizeof text, "%.*g", kDigits, shown);
  if (cells_++ > 0) row_ += ',';
  row_.append(text, static_cast<std::size_t>(length));
  return *this;
}

TableWriter& TableWriter::operator<<(const std::string& text) {
  if (cells_++ > 0) row_ += ',';
  row_ += text;
  return *this;
}

void TableWriter::end_row() {
  if (cells_ != columns_.size()) throw std::logic_error("a row has not a cell for every column of the table");
  row_ += '\n';
  out_ << row_;
  row_.clear();
  cells_ = 0;
}

void TableWriter::flush() {
  if (!out_.flush()) throw std::runtime_error("cannot write the output");
}

void check_writable(const std::string& path) {
  namespace fs = std::filesystem;
  if (path.empty() || (fs::exists(path) && !fs::is_regular_file(path))) return;  // a pipe would end
  if (!std::ofstream(path, std::ios::app)) throw std::runtime_error("cannot write " + path);
}

}  // namespace afm
