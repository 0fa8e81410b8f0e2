// Each lane of a pack makes of a number what the number makes of itself: sines, products, quotients, comparisons, signs
// of zero.
#include <gtest/gtest.h>

#include <cstring>
#include <limits>
#include <random>
#include <string>

#include "core/lanes/sample_row.h"
#include "lane_probe.h"
#include "lane_probe_functions.h"

namespace {

using namespace afm;

bool same(double a, double b) { return std::memcmp(&a, &b, sizeof a) == 0 || (std::isnan(a) && std::isnan(b)); }

void expect_same(LaneProbe probe, const double* x, const double* y, const double* z) {
  double packs[kProbeResults][kProbeLanes], numbers[kProbeResults];
  probe(x, y, z, packs);
  for (int i = 0; i < kProbeLanes; ++i) {
    probe_functions(x[i], y[i], z[i], numbers);
    for (int k = 0; k < kProbeResults; ++k) {
      ASSERT_TRUE(same(packs[k][i], numbers[k])) << "function " << k << " of " << x[i] << ", " << y[i] << ", " << z[i]
                                                 << ": " << packs[k][i] << ", not " << numbers[k];
    }
  }
}

// Of every size that a flight's numbers have, and both signs.
double wide(std::mt19937_64& random) {
  std::uniform_real_distribution<double> mantissa(-2.0, 2.0), exponent(-200.0, 30.0);
  return std::ldexp(mantissa(random), static_cast<int>(exponent(random)));
}

void expect_all_same(LaneProbe probe) {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> turns(-20.0, 20.0), eighth(-0.125, 0.125);
  double x[kProbeLanes], y[kProbeLanes], z[kProbeLanes];
  for (int n = 0; n < 200000; ++n) {
    for (int i = 0; i < kProbeLanes; ++i) {
      x[i] = n % 2 == 0 ? turns(random) : wide(random);
      y[i] = n % 3 == 0 ? wide(random) : eighth(random);
      z[i] = n % 5 == 0 ? y[i] : wide(random);
    }
    ASSERT_NO_FATAL_FAILURE(expect_same(probe, x, y, z));
  }
  // quarters of a turn, zeros of both signs; with each other
  const double edges[] = {0.0,  -0.0, 0.25,  -0.25,  0.5,       1.0,
                          -1.0, 3.0,  0.125, -0.125, 0x1p-1022, std::numeric_limits<double>::quiet_NaN()};
  for (const double a : edges) {
    for (const double b : edges) {
      for (int i = 0; i < kProbeLanes; ++i) x[i] = a, y[i] = b, z[i] = edges[i];
      if (std::abs(a) == 0x1p-1022) continue;  // `over` is a division of normal numbers
      ASSERT_NO_FATAL_FAILURE(expect_same(probe, x, y, z));
    }
  }
}

TEST(Lanes, FourDoAsNumbersDo) {
  if (lanes::sampler_in(4) == nullptr) GTEST_SKIP() << "no AVX2 here";
  expect_all_same(probe_avx2);
}

TEST(Lanes, EightDoAsNumbersDo) {
  if (lanes::sampler_in(8) == lanes::sampler_in(4)) GTEST_SKIP() << "no AVX-512 here";
#ifdef AFM_WIDE_LANES
  expect_all_same(probe_avx512);
#endif
}

}  // namespace
