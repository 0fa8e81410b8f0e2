// Frictionless contact: the springs of the paper's section IV with the reaction of the surface. The tip slides on y =
// h(x) while the surface presses, and leaves it when the reaction would have to pull. One segment is a Taylor series.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>

#include "slide_series.h"

namespace afm::detail {

// Binary digits of the velocity at the end of a segment: 48 give an error of 1e-14, above the rounding of the series.
constexpr int kSlideBits = 48;

template <class T>
class SlideSegment {
 public:
  // The length is chosen so that the last terms of the series are at most three times 2^-bits up to there.
  // Precondition: `start` is on the surface.
  SlideSegment(const SpringConstants<T>& springs, const T& eta, const SlideState<T>& start, int bits = kSlideBits)
      : m_(springs), eta_(eta), start_(start) {
    write_slide_series(springs, eta, start, series_);
    length_ = choose_length(bits);
  }

  SlideState<T> at(const T& s) const;
  T pressure(const T& s) const { return horner(series_.lambda, s); }  // the reaction along y [a/tau^2]
  T displacement_integral(const T& s) const;                          // of x - x(start) over time [a tau]

  T length() const { return length_; }  // [tau]
  const SlideState<T>& start() const { return start_; }
  const Series<T>& displacement() const { return series_.d; }   // x - x(start)
  const Series<T>& reaction() const { return series_.lambda; }  // along y [a/tau^2]
  const T& eta() const { return eta_; }
  const SpringConstants<T>& springs() const { return m_; }

 private:
  T choose_length(int bits) const;

  SpringConstants<T> m_;
  T eta_;
  SlideState<T> start_;
  SlideSeries<T> series_;
  T length_;
};

// The length at which the last two terms of the velocity are about 2^-bits. For the hammer, whose velocity is given, we
// use the reaction. The bits of a double, read as an integer, are its logarithm to the base 2 within 0.09 (times 2^52).
// Arithmetic with them is fast and gives the same bits on every machine.
template <class T>
T SlideSegment<T>::choose_length(int bits) const {
  constexpr std::int64_t kBit = std::int64_t{1} << 52, kOne = 1023 * kBit;
  const Series<T>& c = static_cast<double>(m_.is_free_along_x) == 0.0 ? series_.lambda : series_.u;
  double longest = 8.0;  // [tau] a choice: as far as a flight is searched at once
#pragma GCC unroll 2
  for (std::size_t n = kSlideOrder - 1; n <= kSlideOrder; ++n) {
    const double last = std::abs(static_cast<double>(c[n]));
    if (!(last > 1e-290 && last < 1e290)) continue;  // a zero term sets no length; a huge one is of a corrupted state
    std::int64_t logarithm;
    std::memcpy(&logarithm, &last, sizeof last);
    logarithm = (kOne - bits * kBit - logarithm) / static_cast<std::int64_t>(n) + kOne;
    double length;
    std::memcpy(&length, &logarithm, sizeof length);
    longest = std::min(longest, length);
  }
  return T(longest);
}

template <class T>
SlideState<T> SlideSegment<T>::at(const T& s) const {
  const T d = horner(series_.d, s);
  return {start_.phase + d, start_.X + (d - eta_ * s), horner(series_.u, s)};
}

template <class T>
T SlideSegment<T>::displacement_integral(const T& s) const {
  Series<T> mean = series_.d;
#pragma GCC unroll 32
  for (std::size_t k = 1; k <= kSlideOrder; ++k) mean[k] = series_.d[k] * T(1.0 / static_cast<double>(k + 1));
  return s * horner(mean, s);
}

}  // namespace afm::detail
