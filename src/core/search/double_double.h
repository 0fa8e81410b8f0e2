// Double-double: a number as the unevaluated sum of two doubles, with about 31 digits and errors of a few units of
// 2^-104. It decides grazes that rounding hides in double (Lemma 7 of docs/algorithm.md). It is slow, so it is used
// only there.
#pragma once

#include <cmath>

#include "afm/detail/turns.h"

namespace afm::detail {

class DoubleDouble {
 public:
  DoubleDouble() = default;
  DoubleDouble(double value) : high_(value) {}  // implicit, as every double is one
  DoubleDouble(double high, double low) : high_(high), low_(low) {}

  explicit operator double() const { return high_; }
  double high() const { return high_; }
  double low() const { return low_; }

  friend DoubleDouble operator-(const DoubleDouble& a) { return {-a.high_, -a.low_}; }
  friend DoubleDouble operator+(const DoubleDouble& a, const DoubleDouble& b) {
    const DoubleDouble s = two_sum(a.high_, b.high_), t = two_sum(a.low_, b.low_);
    const DoubleDouble c = quick_two_sum(s.high_, s.low_ + t.high_);
    return quick_two_sum(c.high_, c.low_ + t.low_);
  }
  friend DoubleDouble operator-(const DoubleDouble& a, const DoubleDouble& b) { return a + (-b); }
  friend DoubleDouble operator*(const DoubleDouble& a, const DoubleDouble& b) {
    const double p = a.high_ * b.high_;
    const double e = std::fma(a.high_, b.high_, -p);
    return quick_two_sum(p, e + (a.high_ * b.low_ + a.low_ * b.high_));
  }
  friend DoubleDouble operator/(const DoubleDouble& a, const DoubleDouble& b) {
    const double q1 = a.high_ / b.high_;
    const DoubleDouble r1 = a - b * DoubleDouble(q1);
    const double q2 = r1.high_ / b.high_;
    const DoubleDouble r2 = r1 - b * DoubleDouble(q2);
    return quick_two_sum(q1, q2) + DoubleDouble(r2.high_ / b.high_);
  }

  friend bool operator<(const DoubleDouble& a, const DoubleDouble& b) {
    return a.high_ < b.high_ || (a.high_ == b.high_ && a.low_ < b.low_);
  }
  friend bool operator>(const DoubleDouble& a, const DoubleDouble& b) { return b < a; }
  friend bool operator<=(const DoubleDouble& a, const DoubleDouble& b) { return !(b < a); }

  friend DoubleDouble abs(const DoubleDouble& a) { return a.high_ < 0.0 ? -a : a; }
  friend DoubleDouble sqrt(const DoubleDouble& a) {
    if (!(a.high_ > 0.0)) return {0.0};
    const double root = std::sqrt(a.high_);
    const DoubleDouble rest = a - DoubleDouble(root) * DoubleDouble(root);
    return quick_two_sum(root, rest.high_ / (2.0 * root));
  }

 private:
  static DoubleDouble two_sum(double a, double b) {
    const double s = a + b, t = s - a;
    return {s, (a - (s - t)) + (b - t)};
  }
  static DoubleDouble quick_two_sum(double a, double b) {
    const double s = a + b;
    return {s, b - (s - a)};
  }

  double high_ = 0.0, low_ = 0.0;
};

template <>
inline DoubleDouble epsilon<DoubleDouble>() {
  return {4.930380657631324e-32};
}
template <>
inline DoubleDouble two_pi<DoubleDouble>() {
  return {6.283185307179586, 2.4492935982947064e-16};
}

// a * b minus the nearest integer. The error is that of the rest, not that of a * b, if one of them is a double, as drag
// speeds and ratios of frequencies are. Precondition: |a b| < 2^51.
inline DoubleDouble turn_product(const DoubleDouble& a, const DoubleDouble& b) {
  const double p = a.high() * b.high(), q = a.high() * b.low(), r = a.low() * b.high();
  const DoubleDouble turn(p - nearest(p)), rest(std::fma(a.high(), b.high(), -p));
  return turn + rest + DoubleDouble(q, std::fma(a.high(), b.low(), -q)) +
         DoubleDouble(r, std::fma(a.low(), b.high(), -r));
}

SinCos<DoubleDouble> sin_cos_turns(const DoubleDouble& x);
SmallTurn<DoubleDouble> small_turn(const DoubleDouble& x);

}  // namespace afm::detail
