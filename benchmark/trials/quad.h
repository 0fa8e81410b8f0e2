// The core's templates in quad precision: the truth that tests compare with. AFM_QUADMATH: the compiler has libquadmath
// (GCC on x86-64). Elsewhere Boost does the same 113 bits in software.
#pragma once

#ifdef AFM_QUADMATH
#include <boost/multiprecision/float128.hpp>
#else
#include <boost/multiprecision/cpp_bin_float.hpp>
#endif
#include <limits>

#include "afm/detail/turns.h"
#include "core/search/double_double.h"

namespace afm {

#ifdef AFM_QUADMATH
using Quad = boost::multiprecision::float128;
#else
using Quad = boost::multiprecision::cpp_bin_float_quad;
#endif

template <>
inline Quad detail::epsilon<Quad>() {
  return std::numeric_limits<Quad>::epsilon();
}
template <>
inline Quad detail::two_pi<Quad>() {
  static const Quad value("6.2831853071795864769252867665590057683943");
  return value;
}

inline Quad to_quad(const detail::DoubleDouble& x) { return Quad(x.high()) + Quad(x.low()); }

}  // namespace afm

// the templates find these by the namespace of their argument
namespace boost {
namespace multiprecision {

using afm::Quad;

inline Quad turn_product(const Quad& a, const Quad& b) {
  const Quad p = a * b;
  return p - round(p);
}

inline afm::detail::SinCos<Quad> sin_cos_turns(const Quad& x) {
  const Quad quarter = round(x * 4);
  const Quad angle = afm::detail::two_pi<Quad>() * (x - quarter / 4);
  const Quad s = sin(angle), c = cos(angle);
  const Quad turn = quarter / 4 - floor(quarter / 4);
  if (turn == 0) return {s, c};
  if (turn == Quad(0.25)) return {c, -s};
  if (turn == Quad(0.5)) return {-s, -c};
  return {-c, s};
}

inline afm::detail::SmallTurn<Quad> small_turn(const Quad& x) {
  const Quad angle = afm::detail::two_pi<Quad>() * x, half = sin(angle / 2);
  Quad term = angle, tail = 0;
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
