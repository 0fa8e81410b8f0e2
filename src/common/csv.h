// Tables of numbers as text, a row a line.
#pragma once

#include <cstddef>
#include <istream>
#include <string>
#include <vector>

namespace afm {

// The lines that hold something, without the line end of either world, a byte order mark, or spaces around; numbered as
// an editor numbers them.
class CsvLines {
 public:
  explicit CsvLines(std::istream& in) : in_(in) {}

  bool next(std::string& line);
  std::size_t number() const { return number_; }  // of the line read last

 private:
  std::istream& in_;
  std::size_t number_ = 0;
};

// Fields without the spaces around them.
std::vector<std::string> split_fields(const std::string& line);

// The whole text as one number; false where it is not one. nan and inf are numbers here.
bool parse_number(const std::string& text, double& value);

}  // namespace afm
