// Where a polynomial first falls to zero, against ones of known roots, and against looking everywhere.
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <vector>

#include "core/contact/slide_release.h"
#include "trials/random_launches.h"

namespace afm {

using namespace detail;

namespace {

// positive at 0, and zero at all of these
Polynomial with_roots(const std::vector<double>& roots) {
  Polynomial p{1.0};
  for (const double root : roots) {
    for (std::size_t k = kSlideOrder; k >= 1; --k) p[k] -= p[k - 1] / root;
  }
  return p;
}

constexpr double kTolerance = 1e-13;

TEST(FirstFall, IsAtTheLeastOfTheRootsThatThereAre) {
  RandomLaunches random(1);
  for (int i = 0; i < 5000; ++i) {
    std::vector<double> roots;
    for (int n = 1 + i % 6; n > 0; --n) roots.push_back(random.within(0.05, 1.5));
    std::sort(roots.begin(), roots.end());
    if (std::abs(roots[0] - 1.0) < 1e-3) continue;
    const Polynomial p = with_roots(roots);
    const double fall = first_fall(p, 1.0, kTolerance);
    if (roots[0] > 1.0) {
      ASSERT_LT(fall, 0.0) << i << ": " << roots[0];
      continue;
    }
    ASSERT_LE(std::abs(horner(p, fall)), kTolerance) << i;
    if (roots.size() == 1 || roots[1] - roots[0] > 0.01) {
      ASSERT_NEAR(fall, roots[0], 1e-9) << i;
    }
  }
}

// 1e-9 from a double root: a sample that saw it would have to be within 3e-5 of it
TEST(FirstFall, TellsATouchFromAMiss) {
  RandomLaunches random(2);
  for (int i = 0; i < 1000; ++i) {
    const double touch = random.within(0.1, 0.9);
    Polynomial p = with_roots({touch, touch, random.within(1.5, 3.0)});
    p[0] += 1e-9;
    ASSERT_LT(first_fall(p, 1.0, kTolerance), 0.0) << i << " at " << touch;
    p[0] -= 2e-9;
    const double fall = first_fall(p, 1.0, kTolerance);
    ASSERT_NEAR(fall, touch, 1e-3) << i;
    ASSERT_LT(fall, touch) << i << ": the second of two falls";
  }
}

TEST(FirstFall, NothingOfARandomSeriesIsBelowZeroBeforeIt) {
  RandomLaunches random(3);
  int falls = 0;
  for (int i = 0; i < 3000; ++i) {
    Polynomial p{random.within(0.01, 1.0)};
    for (std::size_t k = 1; k <= kSlideOrder; ++k) p[k] = random.within(-1.0, 1.0) * (i % 2 == 0 ? 1.0 : 5.0);
    const double length = random.within(0.3, 1.2), fall = first_fall(p, length, kTolerance);
    falls += fall >= 0.0 ? 1 : 0;
    const double end = fall >= 0.0 ? fall : length;
    for (int k = 0; k <= 500; ++k) ASSERT_GT(horner(p, end * k / 500.0), -1e-12) << i << ": " << k << " of " << end;
  }
  EXPECT_GT(falls, 500);
  EXPECT_LT(falls, 2500);
}

// As of a saved state that was altered.
TEST(FirstFall, EndsWhateverTheNumbers) {
  using Limits = std::numeric_limits<double>;
  for (const double odd : {Limits::infinity(), -Limits::infinity(), Limits::quiet_NaN(), 1e308, -1e308, 5e-324}) {
    for (std::size_t k = 0; k <= kSlideOrder; ++k) {
      Polynomial p{1.0, -2.0};
      p[k] = odd;
      const double fall = first_fall(p, 8.0, kTolerance);
      EXPECT_FALSE(fall > 8.0) << odd << " of order " << k;
    }
  }
}

}  // namespace
}  // namespace afm
