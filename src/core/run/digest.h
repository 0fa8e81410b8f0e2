// A 64-bit hash of numbers, bit for bit and in order.
#pragma once

#include <cinttypes>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <string>

namespace afm {

class Digest {
 public:
  // Each step is one to one in the state: a single number that differs always shows. Six cycles a number.
  void add(std::uint64_t word) {
    hash_ = (hash_ ^ word) * 0x9e3779b97f4a7c15u;
    hash_ ^= hash_ >> 32;
  }
  void add(double value) {
    std::uint64_t word;
    std::memcpy(&word, &value, sizeof word);
    add(word);
  }
  std::uint64_t value() const { return hash_; }

 private:
  std::uint64_t hash_ = 0xcbf29ce484222325u;
};

inline std::string to_text(const Digest& digest) {
  char text[17];
  std::snprintf(text, sizeof text, "%016" PRIx64, digest.value());
  return text;
}

}  // namespace afm
