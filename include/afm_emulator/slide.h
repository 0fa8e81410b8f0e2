// Frictionless contact: the tip slides on y = h(x) while the surface presses, and leaves exactly when the reaction
// would have to pull. One piece is a Taylor series about its start; pieces follow each other.
#pragma once

#include <algorithm>
#include <cmath>

#include "afm_emulator/first_fall.h"
#include "afm_emulator/slide_series.h"

namespace afm {

constexpr int kSlideBits = 50;

template <class T>
class SlidePiece {
 public:
  // At length() the last terms are below 2^-bits: at 50 the series is good to 3e-14 up to there.
  SlidePiece(const Mechanics<T>& mechanics, const T& eta, const SlideState<T>& start, int bits = kSlideBits);

  SlideState<T> at(const T& s) const;
  T pressure(const T& s) const { return horner(pressure_, s); }  // reaction along y [a/tau^2]
  T pressure_rate(const T& s) const { return pressure_jet(s)[1]; }
  std::array<T, 4> pressure_jet(const T& s) const;  // and its first three time derivatives
  T displacement_integral(const T& s) const;        // of x - x(start) over time [a tau]

  T length() const { return length_; }  // [tau]
  const SlideState<T>& start() const { return start_; }
  const Series<T>& displacement() const { return d_; }  // x - x(start)
  const T& eta() const { return eta_; }
  const Mechanics<T>& mechanics() const { return m_; }

  // First time in [0, length()] at which the pressure has fallen to -release_noise() of the start, within a thousandth
  // of that; a negative number where it does not.
  T find_release() const;

 private:
  T choose_length(int bits) const;

  Mechanics<T> m_;
  T eta_;
  SlideState<T> start_;
  Series<T> d_, u_, pressure_;  // x - x(start), lab velocity, pressure: powers of the time since the start
  T length_;
};

template <class T>
SlidePiece<T>::SlidePiece(const Mechanics<T>& mechanics, const T& eta, const SlideState<T>& start, int bits)
    : m_(mechanics), eta_(eta), start_(start) {
  const SlideSeries<T> series(mechanics, eta, start);
  d_ = series.d;
  u_ = series.u;
  pressure_ = series.lambda;
  length_ = choose_length(bits);
}

// So that the last two terms of the velocity, or of the pressure where the velocity is given, are below 2^-bits. In
// quarter powers of 2 and from exponents alone, which are the same on every machine.
template <class T>
T SlidePiece<T>::choose_length(int bits) const {
  constexpr double kLongest = 8.0;  // [tau]
  constexpr double kQuarterPowers[4] = {1.0, 1.189207115002721, 1.4142135623730951, 1.681792830507429};
  const bool held = static_cast<double>(m_.mobility) == 0.0;
  double length = kLongest;
  for (std::size_t n = kSlideOrder - 1; n <= kSlideOrder; ++n) {
    const double c = std::abs(static_cast<double>(held ? pressure_[n] : u_[n]));
    if (!(c > 1e-290 && c < 1e290)) continue;  // nothing to choose by; beyond, of a state that was altered
    const int quarters = 4 * (-bits - std::ilogb(c)) / static_cast<int>(n);
    const int whole = quarters >= 0 ? quarters / 4 : -((3 - quarters) / 4);
    length = std::min(length, std::ldexp(kQuarterPowers[quarters - 4 * whole], whole));
  }
  return T(length);
}

template <class T>
SlideState<T> SlidePiece<T>::at(const T& s) const {
  const T d = horner(d_, s);
  return {start_.phase + d, start_.X + (d - eta_ * s), horner(u_, s)};
}

template <class T>
T SlidePiece<T>::displacement_integral(const T& s) const {
  Series<T> mean = d_;
#pragma GCC unroll 32
  for (std::size_t k = 1; k <= kSlideOrder; ++k) mean[k] = d_[k] * T(1.0 / static_cast<double>(k + 1));
  return s * horner(mean, s);
}

template <class T>
std::array<T, 4> SlidePiece<T>::pressure_jet(const T& s) const {
  using std::fma;
  std::array<T, 4> c{};  // Horner's scheme for the function and, over k!, its derivatives
  for (std::size_t k = kSlideOrder + 1; k-- > 0;) {
#pragma GCC unroll 4
    for (std::size_t i = 3; i >= 1; --i) c[i] = fma(c[i], s, c[i - 1]);
    c[0] = fma(c[0], s, pressure_[k]);
  }
  c[2] *= T(2.0), c[3] *= T(6.0);
  return c;
}

// Of the sum of a series from its value at 0, up to s.
template <class T>
T largest_change(const Series<T>& series, const T& s) {
  using std::abs;
  using std::fma;
  const T s2 = s * s;
  T even(0.0), odd(0.0);
  for (std::size_t k = kSlideOrder; k >= 2; k -= 2) {
    even = fma(even, s2, abs(series[k]));
    odd = fma(odd, s2, abs(series[k - 1]));
  }
  return s * fma(even, s, odd);
}

template <class T>
T SlidePiece<T>::find_release() const {
  constexpr double kPart = 1.0 / 1024.0;
  const T noise = release_noise(m_, start_.u, start_.X);
  Series<T> pull = pressure_;
  pull[0] = pull[0] + noise;
  if (pull[0] > largest_change(pressure_, length_)) return T(-1.0);
  return pull[0] <= T(kPart) * noise ? T(0.0) : first_fall(pull, length_, T(kPart * noise));
}

}  // namespace afm
