// Inputs made from inputs that are kept: without a fuzzer's eye for what is new, but in every build and at its full
// speed.
#pragma once

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <limits>
#include <random>
#include <vector>

namespace afm::fuzz {

using Input = std::vector<std::uint8_t>;

class Mutator {
 public:
  Mutator(std::vector<Input> kept, std::uint64_t seed) : kept_(std::move(kept)), random_(seed) {}

  Input next() {
    Input input = any();
    for (std::size_t n = 1 + below(6); n > 0; --n) change(input);
    input.resize(std::min(input.size(), kLongest));
    return input;
  }

 private:
  static constexpr std::size_t kLongest = 300;

  // the same on every machine, which the distributions of the standard library are not
  std::size_t below(std::size_t n) { return n > 0 ? random_() % n : 0; }
  std::uint8_t byte() { return static_cast<std::uint8_t>(random_()); }
  const Input& any() { return kept_[below(kept_.size())]; }

  void change(Input& input) {
    const std::size_t at = below(input.size() + 1), rest = input.size() - at;
    const auto here = input.begin() + static_cast<std::ptrdiff_t>(at);
    switch (below(7)) {
      case 0: input.insert(here, byte()); break;
      case 1: input.insert(here, 1 + below(8), byte()); break;
      case 2: input.erase(here, here + static_cast<std::ptrdiff_t>(std::min(rest, 1 + below(8)))); break;
      case 3: splice(input, at); break;
      case 4: overwrite(input, at, awkward()); break;
      case 5: if (rest > 0) *here = byte(); break;
      default: if (rest > 0) *here = static_cast<std::uint8_t>(*here ^ (1u << below(8)));
    }
  }

  // A part of another input takes the place of the end.
  void splice(Input& input, std::size_t at) {
    const Input& other = any();
    const std::size_t from = below(other.size() + 1);
    input.resize(at);
    input.insert(input.end(), other.begin() + static_cast<std::ptrdiff_t>(from), other.end());
  }

  void overwrite(Input& input, std::size_t at, double value) {
    std::uint8_t bytes[sizeof value];
    std::memcpy(bytes, &value, sizeof value);
    std::copy_n(bytes, std::min(sizeof bytes, input.size() - at), input.begin() + static_cast<std::ptrdiff_t>(at));
  }

  double awkward() {
    using Limits = std::numeric_limits<double>;
    const double values[] = {0.0,
                             -0.0,
                             1.0,
                             -1.0,
                             Limits::min(),
                             Limits::denorm_min(),
                             Limits::max(),
                             -Limits::max(),
                             Limits::infinity(),
                             Limits::quiet_NaN(),
                             Limits::epsilon(),
                             1e-140,
                             1e-300,
                             1e300,
                             9007199254740992.0};
    return values[below(sizeof values / sizeof values[0])];
  }

  std::vector<Input> kept_;
  std::mt19937_64 random_;
};

}  // namespace afm::fuzz
