// The orders of the series of a slide (slide_series.h), written once for numbers side by side in a struct and for those
// in a register: both give the same bits. The orders are unrolled when compiled, and what is known last comes in last,
// so that nothing else waits for it.
#pragma once

#include <cmath>
#include <cstddef>

#include "multiversion.h"
#include "turns.h"

namespace afm {

constexpr std::size_t kSlideOrder = 18;

// r = -h', c = -h'', u = x', X = x - xc and its rate, omega_v^2 y0; 1 / (1 + r^2), for a tip held along x 0; and that
// times omega_h^2.
template <class T>
struct SlideBeginning {
  T r, c, u, X, X1, weight, inertia, stiffness;
};

// Three numbers side by side, where there is no register for them.
template <class T>
struct Three {
  T a, b, c;

  Three() = default;
  AFM_INLINED Three(const T& x, const T& y, const T& z) : a(x), b(y), c(z) {}
  AFM_INLINED T first() const { return a; }
  AFM_INLINED T second() const { return b; }
  AFM_INLINED T third() const { return c; }
};
template <class T>
AFM_INLINED Three<T> operator+(const Three<T>& x, const Three<T>& y) {
  return {x.a + y.a, x.b + y.b, x.c + y.c};
}
template <class T>
AFM_INLINED Three<T> fma(const Three<T>& x, const Three<T>& y, const Three<T>& z) {
  using std::fma;
  return {fma(x.a, y.a, z.a), fma(x.b, y.b, z.b), fma(x.c, y.c, z.c)};
}

// With the reaction lambda of the surface on a tip of mass 1, along y:
//   x'' = -omega_h^2 X + r lambda,   lambda = y'' + omega_v^2 (h - y0) = c - omega_v^2 y0 - (r u)',
// as y' = -r u and omega_v is the surface's wave number too; r' = c u and c' = -(2 pi)^2 r u. So c u, r u and r lambda
// are all the products there are, worked out side by side. Of x - x(start), x' and lambda the series are written where
// they stay: a copy of what has just been written number by number waits until it is in memory.
template <class T, class Trio>
class SlideOrders {
 public:
  AFM_INLINED SlideOrders(const SlideBeginning<T>& start, T* d_series, T* u_series, T* lambda_series)
      : d(d_series), u(u_series), lambda(lambda_series), inertia(start.inertia), stiffness(start.stiffness) {
    d[0] = T(0.0), d[1] = u[0] = start.u;
    r[0] = start.r, c[0] = start.c, c[1] = -k2() * (start.r * start.u);
    finish_order<0>(T(0.0), T(0.0), (c[0] - start.weight) - u[0] * (c[0] * u[0]), -stiffness * start.X);
    add_order<1>(start.X1);
  }

 private:
  static AFM_INLINED T k2() { return two_pi<T>() * two_pi<T>(); }

  template <std::size_t n>
  AFM_INLINED Trio middle();
  template <std::size_t n>
  AFM_INLINED void add_order(const T& X);
  template <std::size_t n>
  AFM_INLINED void finish_order(const T& cu, const T& ru, const T& rest, const T& pulled);

  T *d, *u, *lambda;
  T inertia, stiffness, pressed[2];  // inertia times lambda[0] and lambda[1]
  T r[kSlideOrder + 1], c[kSlideOrder + 1];
  Trio left[kSlideOrder - 1], right[kSlideOrder - 1];
};

// Of orders n, n + 1 and n of c u, r u and r lambda the sums of the terms of which either factor is of the second order
// at least, and neither is of the newest.
template <class T, class Trio>
template <std::size_t n>
AFM_INLINED Trio SlideOrders<T, Trio>::middle() {
  Trio low(T(0.0), T(0.0), T(0.0)), high = low;
  if constexpr (n >= 4) {
    left[n - 2] = Trio(c[n - 2], r[n - 1], r[n - 2]);
    right[n - 2] = Trio(u[n - 2], u[n - 2], lambda[n - 2]);
  }
#pragma GCC unroll 32
  for (std::size_t k = n / 2; k >= 2; --k) low = fma(left[k], right[n - k], low);
#pragma GCC unroll 32
  for (std::size_t k = n / 2 + 1; k + 2 <= n; ++k) high = fma(left[k], right[n - k], high);
  return low + high;
}

// c and X are known to order n + 1, r and u to n, lambda to n - 1.
template <class T, class Trio>
template <std::size_t n>
AFM_INLINED void SlideOrders<T, Trio>::add_order(const T& X) {
  using std::fma;
  constexpr double kNext = static_cast<double>(n + 1);
  T cu(0.0), ru(0.0), pulled = -stiffness * X;
  if constexpr (n > 2) {
    const Trio sums = middle<n>();
    cu = fma(c[n - 1], u[1], sums.first());
    ru = fma(r[2], u[n - 1], sums.second());
    pulled = fma(r[n - 1], pressed[1], pulled);
    pulled = fma(inertia, sums.third(), fma(r[n], pressed[0], pulled));
  }
  if constexpr (n == 2) pulled = fma(r[n], pressed[0], pulled);
  if constexpr (n > 1) {
    cu = fma(c[1], u[n - 1], cu);
    ru = fma(r[n], u[1], ru);
  }
  cu = fma(c[n], u[0], cu);
  const T newest = T(kNext + 1.0) * r[1];  // as r[1] = c[0] u[0]
  const T rest = fma(-newest, u[n], fma(T(-kNext), ru, fma(-u[0], cu, c[n])));
  finish_order<n>(cu, fma(r[1], u[n], ru), rest, fma(inertia * r[1], lambda[n - 1], pulled));
  if constexpr (n < kSlideOrder) add_order<n + 1>(d[n + 1]);
}

// Of order n: c u without c[0] u[n], inertia x'' without r[0] lambda, lambda without r[0] x''; of order n + 1 r u
// without r[0] and u[0]. x'' and lambda, of which either has the other beside r[0], follow, and from them what is next.
template <class T, class Trio>
template <std::size_t n>
AFM_INLINED void SlideOrders<T, Trio>::finish_order(const T& cu, const T& ru, const T& rest, const T& pulled) {
  using std::fma;
  constexpr double kPerNext = 1.0 / static_cast<double>(n + 1), kPerSecond = 1.0 / static_cast<double>(n + 2);
  const T a = fma(r[0] * inertia, rest, pulled);
  lambda[n] = fma(-r[0], a, rest);
  if constexpr (n < 2) pressed[n] = inertia * lambda[n];
  if constexpr (n < kSlideOrder) {
    u[n + 1] = a * T(kPerNext);
    r[n + 1] = fma(c[0], u[n], cu) * T(kPerNext);
  }
  if constexpr (n + 2 <= kSlideOrder) {
    c[n + 2] = T(-k2() * T(kPerSecond)) * fma(r[0], u[n + 1], fma(u[0], r[n + 1], ru));
    d[n + 2] = u[n + 1] * T(kPerSecond);
  }
}

}  // namespace afm
