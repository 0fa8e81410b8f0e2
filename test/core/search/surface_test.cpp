#include "afm/surface.h"

#include <gtest/gtest.h>

#include "trials/quad.h"

namespace afm {
namespace {

constexpr double kH = 0.05 / 0.52;

TEST(Surface, TheCrestIsAtZeroAndTheValleyAtAHalf) {
  const SurfaceJet<double> crest = surface_jet(kH, 0.0), valley = surface_jet(kH, 0.5);
  EXPECT_EQ(crest.h, kH);
  EXPECT_EQ(crest.h1, 0.0);
  EXPECT_LT(crest.h2, 0.0);
  EXPECT_EQ(valley.h, -kH);
  EXPECT_EQ(valley.h1, 0.0);
  EXPECT_GT(valley.h2, 0.0);
}

TEST(Surface, EachDerivativeIsTheSlopeOfTheOneBefore) {
  const Quad H(kH), step(1e-12);
  for (int i = 0; i < 100; ++i) {
    const Quad x = Quad(i) / 97;
    const SurfaceJet<Quad> here = surface_jet(H, x);
    const SurfaceJet<Quad> up = surface_jet(H, Quad(x + step)), down = surface_jet(H, Quad(x - step));
    EXPECT_LE(static_cast<double>(abs((up.h - down.h) / (2 * step) - here.h1)), 1e-19);
    EXPECT_LE(static_cast<double>(abs((up.h1 - down.h1) / (2 * step) - here.h2)), 1e-19);
    EXPECT_LE(static_cast<double>(abs((up.h2 - down.h2) / (2 * step) - here.h3)), 1e-18);
  }
}

TEST(Surface, PhasesWrapIntoOneCell) {
  EXPECT_EQ(wrap_phase(0.0), 0.0);
  EXPECT_EQ(wrap_phase(3.25), 0.25);
  EXPECT_EQ(wrap_phase(-0.25), 0.75);
  EXPECT_EQ(wrap_phase(7.0), 0.0);
  EXPECT_EQ(wrap_phase(-1e-20), 0.0);  // 1 - 1e-20 rounds to 1, which is the next cell's 0
  for (double x = -3.0; x < 3.0; x += 0.01) {
    EXPECT_GE(wrap_phase(x), 0.0);
    EXPECT_LT(wrap_phase(x), 1.0);
  }
}

}  // namespace
}  // namespace afm
