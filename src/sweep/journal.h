// What an interrupted run leaves behind so that the next goes on: one line saying what is computed, then a line for
// each point done, written out at once. A line cut short by a kill is dropped; the numbers come back as the same bits.
#pragma once

#include <cstddef>
#include <cstdio>
#include <map>
#include <string>

#include "packed.h"

namespace afm {

class Journal {
 public:
  // Opens the journal of a run, or begins one. Throws std::runtime_error, in words for the user, where it belongs to
  // another run, another process is writing it, or it cannot be read or written.
  Journal(const std::string& path, const std::string& identity, bool begin_again);
  ~Journal();
  Journal(const Journal&) = delete;
  Journal& operator=(const Journal&) = delete;

  const std::map<std::size_t, PackedResult>& found() const { return found_; }  // by position
  void append(std::size_t position, const PackedResult& result);               // throws std::runtime_error

 private:
  void lock();
  void read(const std::string& identity);
  void write(const std::string& text);

  std::string path_;
  std::FILE* file_;
  std::map<std::size_t, PackedResult> found_;
};

}  // namespace afm
