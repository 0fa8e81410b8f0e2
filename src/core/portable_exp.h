// Exponential and logarithm with the same bits on every machine, which those of the C library do not have.
#pragma once

#include <cmath>
#include <cstdint>
#include <cstring>

#include "afm_emulator/multiversion.h"

namespace afm {

// Natural logarithm to 1e-15 of 0 < x.
AFM_INLINED double portable_log(double x) {
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

// e^x to 1e-15 of |x| < 700; beyond it some number or none, the same everywhere.
AFM_INLINED double portable_exp(double x) {
  constexpr double kLog2High = 0.693147180369123816490, kLog2Low = 1.90821492927058770002e-10;
  constexpr double kRounder = 6755399441055744.0;  // 1.5 * 2^52: adding and taking it away rounds to a whole number
  const double shifted = x * 1.4426950408889634 + kRounder, k = shifted - kRounder;
  const double r = std::fma(-k, kLog2Low, std::fma(-k, kLog2High, x));
  const double r2 = r * r, r4 = r2 * r2;
  // terms in pairs, pairs in pairs: little waits for what is before it
  const auto pair = [&](double c0, double c1) { return std::fma(r, c1, c0); };
  const double p0 = std::fma(r2, pair(1.0 / 2, 1.0 / 6), 1.0 + r);
  const double p4 = std::fma(r2, pair(1.0 / 720, 1.0 / 5040), pair(1.0 / 24, 1.0 / 120));
  const double p8 = std::fma(r2, pair(1.0 / 3628800, 1.0 / 39916800), pair(1.0 / 40320, 1.0 / 362880));
  const double p12 = pair(1.0 / 479001600, 1.0 / 6227020800.0);
  const double sum = std::fma(r4 * r4, std::fma(r4, p12, p8), std::fma(r4, p4, p0));
  std::uint64_t bits;
  std::memcpy(&bits, &shifted, sizeof bits);
  bits = (bits + 1023) << 52;  // 2^k, as the last bits are k
  double power;
  std::memcpy(&power, &bits, sizeof power);
  return sum * power;
}

}  // namespace afm
