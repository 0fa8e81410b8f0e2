// Arithmetic that is written once for a number and for a pack of numbers (src/core/lanes/pack.h), to the same bits.
#pragma once

#include <cmath>

#include "multiversion.h"

namespace afm {

template <class T>
T select(bool condition, const T& yes, const T& no) {
  return condition ? yes : no;
}

// x / d. For doubles and packs a product with 1/d: faster, with an error of up to 1.5 ulp.
template <class T>
T over(const T& x, double d) {
  return x / T(d);
}
AFM_INLINED double over(double x, double d) { return x * (1.0 / d); }

// a b + c. For doubles and packs fused, which is rounded once.
template <class T>
T mul_add(const T& a, const T& b, const T& c) {
  return a * b + c;
}
AFM_INLINED double mul_add(double a, double b, double c) { return std::fma(a, b, c); }

}  // namespace afm
