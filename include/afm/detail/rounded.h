// Arithmetic of the templates that is rounded otherwise for a double.
#pragma once

#include <cmath>

namespace afm::detail {

// x / d. For doubles a product with 1/d: faster, with an error of up to 1.5 ulp.
template <class T>
T divide(const T& x, double d) {
  return x / T(d);
}
inline double divide(double x, double d) { return x * (1.0 / d); }

// a b + c. For doubles fused, which is rounded once.
template <class T>
T mul_add(const T& a, const T& b, const T& c) {
  return a * b + c;
}
inline double mul_add(double a, double b, double c) { return std::fma(a, b, c); }

// w / omega, exact beyond the last digit. With a rounded 1 / omega every turn of a spring would add or remove energy.
template <class T>
T divide_by_omega(const T& w, const T& omega, const T& inverse) {
  return mul_add(w, inverse, T((w * inverse) * mul_add(T(-omega), inverse, T(1.0))));
}

}  // namespace afm::detail
