// What a fuzz target has in common with the next: libFuzzer's entry, and how it tells of a finding.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace afm::fuzz {

// A finding: both libFuzzer and the replay of old inputs take an abort for one.
inline void require(bool holds, const std::string& what) {
  if (holds) return;
  std::fprintf(stderr, "FOUND: %s\n", what.c_str());
  std::abort();
}

}  // namespace afm::fuzz
