// Writes and reads the words of a saved state.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>

#include "afm/saved_state.h"

namespace afm {

class Writer {
 public:
  explicit Writer(SavedState& out) : out_(out) { out_.size = 0; }
  template <class T>
  void number(const T& value) {
    put(static_cast<std::uint64_t>(value));
  }
  template <class T>
  void whole(const T& object) {
    std::memcpy(out_.words.data() + out_.size, &object, sizeof object);
    out_.size += sizeof object / sizeof(std::uint64_t);
  }

 private:
  void put(std::uint64_t word) { out_.words[out_.size++] = word; }
  SavedState& out_;
};

// It reads nothing beyond the end; an object that would lie there keeps its value.
class Reader {
 public:
  explicit Reader(const SavedState& in) : in_(in) {}
  template <class T>
  void number(T& value) {
    std::uint64_t word = 0;
    whole(word);
    value = static_cast<T>(word);
    valid_ = valid_ && static_cast<std::uint64_t>(value) == word;
  }
  // Of enumerations and booleans: at most `most`.
  template <class T>
  void choice(T& value, T most) {
    std::uint64_t word = 0;
    whole(word);
    valid_ = valid_ && word <= static_cast<std::uint64_t>(most);
    if (valid_) value = static_cast<T>(word);
  }
  template <class T>
  void whole(T& object) {
    constexpr std::size_t kWords = sizeof object / sizeof(std::uint64_t);
    valid_ = valid_ && in_.size <= SavedState::kMaxWords && kWords <= in_.size - at_;
    if (!valid_) return;
    std::memcpy(static_cast<void*>(&object), in_.words.data() + at_, sizeof object);
    at_ += kWords;
  }
  bool valid() const { return valid_ && at_ == in_.size; }

 private:
  const SavedState& in_;
  std::size_t at_ = 0;
  bool valid_ = true;
};

}  // namespace afm
