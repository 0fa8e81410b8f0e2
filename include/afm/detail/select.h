// Branches written once for a number and for a pack of numbers (lanes.h). Of a number they are plain branches. Of a
// pack each lane gets the value that the number would get: `choose` takes both ways and picks, `either` leaves out a
// way no lane goes.
#pragma once

#include <cmath>
#include <utility>

#include "multiversion.h"

namespace afm {

// What a comparison of two numbers gives: bool, or one for each lane.
template <class T>
using Truth = decltype(std::declval<T>() < std::declval<T>());

template <class F, class G>
auto choose(bool condition, const F& yes, const G& no) {
  return condition ? yes() : no();
}
template <class F, class G>
auto either(bool condition, const F& yes, const G& no) {
  return condition ? yes() : no();
}

// condition && rest(), where the rest costs something.
template <class F>
bool both(bool condition, const F& rest) {
  return condition && rest();
}

template <class T>
T select(bool condition, const T& yes, const T& no) {
  return condition ? yes : no;
}

// x / d; of doubles, and packs of them, within an ulp and a half, sooner than by a division.
template <class T>
T over(const T& x, double d) {
  return x / T(d);
}
AFM_INLINED double over(double x, double d) { return x * (1.0 / d); }

// a b + c; of doubles, and packs of them, rounded once, and sooner than a product and a sum.
template <class T>
T mul_add(const T& a, const T& b, const T& c) {
  return a * b + c;
}
AFM_INLINED double mul_add(double a, double b, double c) { return std::fma(a, b, c); }

}  // namespace afm
