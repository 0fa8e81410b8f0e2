#include "csv.h"

#include <boost/algorithm/string.hpp>
#include <cstdlib>

namespace afm {
namespace {

void trim(std::string& text) { boost::algorithm::trim_if(text, boost::algorithm::is_any_of(" \t\r")); }

}  // namespace

bool CsvLines::next(std::string& line) {
  const std::string byte_order_mark = "\xEF\xBB\xBF";
  while (std::getline(in_, line)) {
    if (++number_ == 1 && line.compare(0, byte_order_mark.size(), byte_order_mark) == 0) {
      line.erase(0, byte_order_mark.size());
    }
    trim(line);
    if (!line.empty()) return true;
  }
  return false;
}

std::vector<std::string> split_fields(const std::string& line) {
  std::vector<std::string> fields;
  boost::algorithm::split(fields, line, boost::algorithm::is_any_of(","));
  for (std::string& field : fields) trim(field);
  return fields;
}

bool parse_number(const std::string& text, double& value) {
  if (text.empty()) return false;
  char* end = nullptr;
  value = std::strtod(text.c_str(), &end);
  return end == text.c_str() + text.size();
}

}  // namespace afm
