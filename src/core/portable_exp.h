// Exponential and logarithm with the same bits on every machine. Those of the C library differ from version to version.
#pragma once

#include <cmath>
#include <cstdint>
#include <cstring>

#include "afm/detail/turns.h"

namespace afm::detail {

// Natural logarithm, x > 0, relative error below 1e-15: by the series of artanh(z), z = (m-1)/(m+1), up to z^23.
inline double portable_log(double x) {
  constexpr double kLog2 = 0.6931471805599453;
  int exponent = 0;
  double m = std::frexp(x, &exponent);
  if (m < 0.7071067811865476) {
    m *= 2.0;
    --exponent;
  }
  const double z = (m - 1.0) / (m + 1.0), z2 = z * z;
  double sum = 0.0;
  for (int k = 23; k >= 1; k -= 2) sum = sum * z2 + 1.0 / k;
  return 2.0 * z * sum + exponent * kLog2;
}

// e^x for |x| < 700, error below 1e-15 of it. Beyond that the result means nothing, but is the same on every machine.
// The terms are added in pairs, which shortens the chain of dependent operations.
inline double portable_exp(double x) {
  constexpr double kLog2High = 0.693147180369123816490, kLog2Low = 1.90821492927058770002e-10;
  const double shifted = x * 1.4426950408889634 + kRounder, k = shifted - kRounder;
  const double r = std::fma(-k, kLog2Low, std::fma(-k, kLog2High, x)), r2 = r * r, r4 = r2 * r2;
  const auto pair = [&](double c0, double c1) { return std::fma(r, c1, c0); };
  const double p0 = std::fma(r2, pair(1.0 / 2, 1.0 / 6), 1.0 + r);
  const double p4 = std::fma(r2, pair(1.0 / 720, 1.0 / 5040), pair(1.0 / 24, 1.0 / 120));
  const double p8 = std::fma(r2, pair(1.0 / 3628800, 1.0 / 39916800), pair(1.0 / 40320, 1.0 / 362880));
  const double p12 = pair(1.0 / 479001600, 1.0 / 6227020800.0);
  std::uint64_t bits;  // of 2^k
  std::memcpy(&bits, &shifted, sizeof bits);
  bits = (bits + 1023) << 52;
  double power;
  std::memcpy(&power, &bits, sizeof power);
  return std::fma(r4 * r4, std::fma(r4, p12, p8), std::fma(r4, p4, p0)) * power;
}

}  // namespace afm::detail
