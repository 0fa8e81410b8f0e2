// The core's templates in quad precision: the truth that tests compare with.
#pragma once

#include <boost/multiprecision/float128.hpp>
#include <limits>

#include "afm/detail/double_double.h"
#include "afm/detail/turns.h"

namespace afm {

using Quad = boost::multiprecision::float128;

template <>
inline Quad epsilon<Quad>() {
  return std::numeric_limits<Quad>::epsilon();
}
template <>
inline Quad two_pi<Quad>() {
  static const Quad value("6.2831853071795864769252867665590057683943");
  return value;
}

inline Quad to_quad(const DoubleDouble& x) { return Quad(x.high()) + Quad(x.low()); }

}  // namespace afm

// the templates find these by the namespace of their argument
namespace boost {
namespace multiprecision {

inline float128 turn_product(const float128& a, const float128& b) {
  const float128 p = a * b;
  return p - round(p);
}

inline afm::SinCos<float128> sin_cos_turns(const float128& x) {
  const float128 quarter = round(x * 4);
  const float128 angle = afm::two_pi<float128>() * (x - quarter / 4);
  const float128 s = sin(angle), c = cos(angle);
  const float128 turn = quarter / 4 - floor(quarter / 4);
  if (turn == 0) return {s, c};
  if (turn == float128(0.25)) return {c, -s};
  if (turn == float128(0.5)) return {-s, -c};
  return {-c, s};
}

inline afm::SmallTurn<float128> small_turn(const float128& x) {
  const float128 angle = afm::two_pi<float128>() * x, half = sin(angle / 2);
  float128 term = angle, tail = 0;
  for (int n = 2; n <= 40; n += 2) {
    term = -term * angle * angle / (n * (n + 1));
    tail += term;
  }
  return {sin(angle), tail, 2 * half * half};
}

}  // namespace multiprecision
}  // namespace boost

namespace afm {

// The distance of a double from the truth, in units of the truth's last place as a double.
inline double error_in_ulp(double value, const Quad& truth) {
  int exponent = 0;
  frexp(truth, &exponent);
  const int lowest = std::numeric_limits<double>::min_exponent - 53;
  const Quad ulp = ldexp(Quad(1), std::max(exponent - 53, lowest));
  return static_cast<double>(abs(value - truth) / ulp);
}

inline double relative_error(const Quad& value, const Quad& truth) {
  return static_cast<double>(abs(value - truth) / abs(truth));
}

}  // namespace afm
