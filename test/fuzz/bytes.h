// What a fuzzer's bytes come to: numbers that are often the awkward ones. Past the end of the bytes everything is zero.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>

namespace afm::fuzz {

class Bytes {
 public:
  Bytes(const std::uint8_t* data, std::size_t size) : next_(data), left_(size) {}

  bool empty() const { return left_ == 0; }

  template <class T>
  T raw() {
    std::uint8_t bytes[sizeof(T)] = {};
    for (std::size_t i = 0; i < sizeof(T) && left_ > 0; ++i, --left_) bytes[i] = *next_++;
    T value;
    std::memcpy(&value, bytes, sizeof value);
    return value;
  }
  std::size_t below(std::size_t n) { return raw<std::uint8_t>() % n; }

  std::string text(std::size_t most) {
    const std::size_t wanted = below(most + 1), n = left_ < wanted ? left_ : wanted;
    const std::string text(reinterpret_cast<const char*>(next_), n);
    next_ += n;
    left_ -= n;
    return text;
  }

  // Between two bounds: the bounds themselves, round and tiny numbers, any bits at all.
  double within(double low, double high) {
    const std::size_t kind = below(8);
    const double part = static_cast<double>(raw<std::uint32_t>()) / 4294967295.0;
    double value = low + part * (high - low);
    if (kind == 0) value = low;
    if (kind == 1) value = high;
    if (kind == 2) value = 0.0;
    if (kind == 3) value = std::round(8.0 * value) / 8.0;
    if (kind == 4) value = std::pow(10.0, 36.0 * part - 18.0);
    if (kind == 5) value = -std::pow(10.0, 36.0 * part - 18.0);
    if (kind == 6) value = raw<double>();
    return value >= low && value <= high ? value : low + part * (high - low);
  }

 private:
  const std::uint8_t* next_;
  std::size_t left_;
};

}  // namespace afm::fuzz
