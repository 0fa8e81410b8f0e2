// Tables as Python takes them.
#pragma once

#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <string>
#include <type_traits>
#include <vector>

#include "common/table_units.h"

namespace afm::python {

namespace py = pybind11;

// Takes the cells of rows, as TableWriter does: numbers, and the one column of text that some tables have.
class TableRows {
 public:
  TableRows& operator<<(double value) {
    numbers_.push_back(value);
    return *this;
  }
  template <class Whole, class = std::enable_if_t<std::is_integral<Whole>::value>>
  TableRows& operator<<(Whole value) {
    return *this << static_cast<double>(value);
  }
  TableRows& operator<<(const std::string& text) {
    names_.push_back(text);
    return *this;
  }
  void end_row() { ++rows_; }

  py::tuple result(const std::vector<Column>& columns) const {
    const std::size_t width = columns.size() - (names_.empty() ? 0 : 1);
    py::array_t<double> matrix(
        std::vector<py::ssize_t>{static_cast<py::ssize_t>(rows_), static_cast<py::ssize_t>(width)});
    std::copy(numbers_.begin(), numbers_.end(), matrix.mutable_data());
    std::vector<std::string> header;
    for (const Column& column : columns) header.push_back(column.name);
    return py::make_tuple(header, matrix, names_);
  }

 private:
  std::vector<double> numbers_;
  std::vector<std::string> names_;
  std::size_t rows_ = 0;
};

}  // namespace afm::python
