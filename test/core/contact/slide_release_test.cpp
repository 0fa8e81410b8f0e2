// Where a slide ends, its mirror image, and rest.
#include <gtest/gtest.h>

#include "afm/tip.h"
#include "support/slides.h"

namespace afm {

using namespace detail;

namespace {

const Model kMica;
const SpringConstants<double> kSpringConstants(kMica);

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
    ASSERT_LT(part.pressure_rate(release), 0.0) << i;
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

TEST(SlideSymmetry, AMirroredSlideIsTheMirrorImageBitForBit) {
  RandomLaunches random(2);
  for (int i = 0; i < 1000; ++i) {
    const SlidePart part = random_part(random);
    const SlideState<double>& start = part.start();
    const SlidePart mirrored(kSpringConstants, -part.eta(), {-start.phase, -start.X, -start.u});
    ASSERT_EQ(mirrored.length(), part.length());
    ASSERT_EQ(find_release(mirrored), find_release(part));
    const double s = part.length() * random.within(0.0, 1.0);
    const SlideState<double> a = part.at(s), b = mirrored.at(s);
    ASSERT_TRUE(a.phase == -b.phase && a.X == -b.X && a.u == -b.u) << i;
    ASSERT_EQ(mirrored.pressure(s), part.pressure(s));
  }
}

// Crests press whatever the height of the spring's rest; bottoms do where it rests below them.
TEST(SlideRest, AtACrestOrAValleyBottomStaysForEver) {
  for (const double phase : {0.0, 0.5}) {
    Model model;
    model.y0 = phase == 0.0 ? 0.0 : -0.2;
    const SlidePart part(SpringConstants<double>(model), 0.0, {phase, 0.0, 0.0});
    EXPECT_GT(part.pressure(0.0), 1.0);
    EXPECT_LT(find_release(part), 0.0);
    for (const double s : {0.1, 1.0, part.length()}) {
      EXPECT_EQ(part.at(s).phase, phase);
      EXPECT_EQ(part.at(s).X, 0.0);
      EXPECT_EQ(part.at(s).u, 0.0);
      EXPECT_EQ(part.pressure(s), part.pressure(0.0));
    }
    EXPECT_GE(part.length(), 1.0);
  }
}

}  // namespace
}  // namespace afm
