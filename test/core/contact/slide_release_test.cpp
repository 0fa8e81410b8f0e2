// Where a slide ends.
#include <gtest/gtest.h>

#include <limits>
#include <vector>

#include "afm/tip.h"
#include "support/slides.h"

namespace afm {

using namespace detail;

namespace {

const Model kMica;

TEST(SlideRelease, IsWhereThePressureEndsAndNeverLate) {
  RandomLaunches random(1);
  int releases = 0;
  for (int i = 0; i < 5000; ++i) {
    const SlidePart part = random_part(random);
    const double release = find_release(part), end = end_of(part);
    constexpr int kSamples = 500;
    for (int k = 0; k < kSamples; ++k) {
      const SlideState<double> at = part.at(end * k / kSamples);
      ASSERT_GT(pressure_of(kMica, at), -kReleaseNoise - 1e-10) << i << " at " << end * k / kSamples << " of " << end;
    }
    if (release < 0.0) continue;
    ++releases;
    ASSERT_NEAR(part.pressure(release), -kReleaseNoise, 2e-12) << i;
    ASSERT_NEAR(pressure_of(kMica, part.at(release)), -kReleaseNoise, 1e-10) << i;
    ASSERT_LT(pressure_slope(part, release), 0.0) << i;
  }
  EXPECT_GT(releases, 300);
}

// Springs and speeds at which a pull of 1e-9 a/tau^2 is less than the rounding of the forces it is left of.
TEST(SlideRelease, IsFollowedByAFlightHoweverLargeTheForces) {
  RandomLaunches random(3);
  int releases = 0, at_once = 0;
  for (int i = 0; i < 6000; ++i) {
    Model model;
    model.gamma = 0.0;
    model.frequency_ratio = std::pow(10.0, random.within(1.0, 3.0));
    const double u = std::pow(10.0, random.within(0.0, 4.0));
    Tip tip(model, random.within(-10.0, 10.0),
            TipState{random.within(0.0, 1.0), random.within(-10.0, 10.0), i % 2 == 0 ? u : -u, 0.0, 0.0});
    const ModelTime end{0, 0.01};
    ModelTime released{-1, 0.0};
    for (int events = 0; events < 100; ++events) {
      const Outcome outcome = tip.advance(end);
      if (outcome == Outcome::time_limit) break;
      if (tip.now() == released) ++at_once;
      if (outcome != Outcome::released) continue;
      released = tip.now();
      ++releases;
    }
  }
  EXPECT_GT(releases, 4000);
  EXPECT_EQ(at_once, 0);
}

// positive at 0, and zero at all of these
Polynomial with_roots(const std::vector<double>& roots) {
  Polynomial p{1.0};
  for (const double root : roots) {
    for (std::size_t k = kSlideOrder; k >= 1; --k) p[k] -= p[k - 1] / root;
  }
  return p;
}

constexpr double kTolerance = 1e-13;

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
