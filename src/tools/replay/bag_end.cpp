#include "bag_end.h"

#include <algorithm>
#include <fstream>

namespace afm::replay {
namespace {

constexpr std::streamoff kMagicLength = 13;

// Little-endian, as bags are whatever the machine.
std::uint64_t number(const std::string& bytes, std::size_t at, std::size_t length) {
  std::uint64_t value = 0;
  for (std::size_t i = std::min(at + length, bytes.size()); i > at; --i) {
    value = value << 8 | static_cast<unsigned char>(bytes[i - 1]);
  }
  return value;
}

std::string read_counted(std::istream& file) {
  std::string count(4, '\0');
  file.read(count.data(), 4);
  std::string bytes(file ? std::min<std::uint64_t>(number(count, 0, 4), 1 << 20) : 0, '\0');
  file.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  return bytes;
}

std::uint64_t field(const std::string& header, const std::string& name, std::size_t length) {
  const std::size_t at = header.find(name + "=");
  return at == std::string::npos ? 0 : number(header, at + name.size() + 1, length);
}

}  // namespace

std::uint64_t bytes_behind(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  file.seekg(0, std::ios::end);
  const std::streamoff size = file.tellg();
  file.seekg(kMagicLength);
  const std::string header = read_counted(file);
  file.seekg(static_cast<std::streamoff>(field(header, "index_pos", 8)));
  // a record of header and data for every connection and every chunk
  for (std::uint64_t n = 2 * (field(header, "conn_count", 4) + field(header, "chunk_count", 4)); n > 0 && file; --n) {
    read_counted(file);
  }
  return file ? static_cast<std::uint64_t>(size - file.tellg()) : 0;
}

}  // namespace afm::replay
