// Four numbers side by side, where there is no register for them.
#pragma once

#include <algorithm>
#include <cmath>

#include "afm/detail/multiversion.h"
#include "collocation.h"
#include "portable_exp.h"

namespace afm {

struct Four {
  double a, b, c, d;

  Four() = default;
  AFM_INLINED Four(double first, double second, double third, double last) : a(first), b(second), c(third), d(last) {}
  explicit AFM_INLINED Four(double all) : Four(all, all, all, all) {}
};

template <class F>
AFM_INLINED Four each(const Four& x, const F& f) {
  return {f(x.a), f(x.b), f(x.c), f(x.d)};
}
template <class F>
AFM_INLINED Four each(const Four& x, const Four& y, const F& f) {
  return {f(x.a, y.a), f(x.b, y.b), f(x.c, y.c), f(x.d, y.d)};
}

AFM_INLINED Four operator+(const Four& x, const Four& y) {
  return each(x, y, [](double p, double q) { return p + q; });
}
AFM_INLINED Four operator-(const Four& x, const Four& y) {
  return each(x, y, [](double p, double q) { return p - q; });
}
AFM_INLINED Four operator*(const Four& x, const Four& y) {
  return each(x, y, [](double p, double q) { return p * q; });
}
AFM_INLINED Four operator/(const Four& x, const Four& y) {
  return each(x, y, [](double p, double q) { return p / q; });
}
AFM_INLINED Four operator-(const Four& x) {
  return each(x, [](double p) { return -p; });
}
AFM_INLINED Four max(const Four& x, const Four& y) {
  return each(x, y, [](double p, double q) { return std::max(p, q); });
}
AFM_INLINED Four mul_add(const Four& x, const Four& y, const Four& z) {
  return {std::fma(x.a, y.a, z.a), std::fma(x.b, y.b, z.b), std::fma(x.c, y.c, z.c), std::fma(x.d, y.d, z.d)};
}
AFM_INLINED Four portable_exp(const Four& x) {
  return each(x, [](double p) { return portable_exp(p); });
}

template <>
AFM_INLINED Four at_every_node<Four>(const double (&x)[4]) {
  return {x[0], x[1], x[2], x[3]};
}
AFM_INLINED Four first_of(const Four& x) { return Four(x.a); }
AFM_INLINED Four second_of(const Four& x) { return Four(x.b); }
AFM_INLINED Four third_of(const Four& x) { return Four(x.c); }
AFM_INLINED Four last_of(const Four& x) { return Four(x.d); }
AFM_INLINED double last_number(const Four& x) { return x.d; }

}  // namespace afm
