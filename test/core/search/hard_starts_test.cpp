// Starts that are hard for the search: stiff springs and the glide.
#include <gtest/gtest.h>

#include <cmath>

#include "afm/impact_search.h"
#include "trials/random_launches.h"

namespace afm {
namespace {

constexpr double kHorizon = 8.0;
constexpr double kEps = 2.220446049250313e-16;

// Its stiff spring turns within the interval that holds the root, where no series of the gap converges.
TEST(HardStart, ATipOnAStiffSpringEndsOnTheSurface) {
  Model model;
  model.frequency_ratio = 1000.0;
  const Mechanics<double> mechanics(model);
  RandomLaunches random(12);
  for (int i = 0; i < 20000; ++i) {
    TipState start = random.next(2.0, -2.0, 1.0);
    start.X *= std::pow(10.0, random.within(-6.0, 0.0));
    start.u = 2.0 + random.within(-1.0, 1.0) * mechanics.omega_h * std::abs(start.X);
    const Flight<double> f(mechanics, 2.0, start);
    const Landing<double> landing = find_landing(model, f, kHorizon);
    ASSERT_EQ(landing.outcome, SearchOutcome::impact) << i;
    const GapJet<double> there = f.gap(landing.s);
    const double late = 4.0 * kEps * landing.s * (std::abs(there.g1) + mechanics.omega_h);
    ASSERT_LT(std::abs(there.g), 4.0 * f.gap_error(landing.s) + late) << i;
    ASSERT_NEAR(landing.jet.state.U, there.state.U, 1e-9 * (1.0 + mechanics.omega_h * f.amplitude_X())) << i;
  }
}

// There the gap swings by itself, however little, and what it swings by may be far below the rounding of places.
TEST(HardStart, OnTheGlideALaunchHoweverSlowLandsHalfATurnLater) {
  for (const ModelKind kind : {ModelKind::oscillator, ModelKind::hammer}) {
    Model model;
    model.kind = kind;
    const Mechanics<double> mechanics(model);
    for (const double g1 : {1e-7, 1e-15}) {
      const Flight<double> flight(mechanics, -1.0, TipState{0.25591284509951961, 0.0, -1.0, 0.0, g1});
      const Landing<double> landing = find_landing(model, flight, kSearchHorizon);
      ASSERT_EQ(landing.outcome, SearchOutcome::impact) << g1;
      EXPECT_NEAR(landing.s, 0.5, 1e-6) << g1;
    }
  }
}

// It would land a quarter of a turn later. Until then the gap has only its fourth derivative, so the steps are short.
TEST(HardStart, OnTheGlideAGapHoweverSmallExhaustsNoSearch) {
  Model model;
  model.kind = ModelKind::hammer;
  model.H = 0.83993305622109515;
  const Mechanics<double> mechanics(model);
  for (const double gap : {1e-21, 1.2e-20, 1e-19, 1e-18, 9e-18, 1.1e-17, 1e-16, 1e-14}) {
    const Flight<double> flight(mechanics, -1.0, TipState{0.53955942957884762, 0.0, -1.0, gap, 0.0});
    const Landing<double> landing = find_landing(model, flight, kSearchHorizon);
    EXPECT_NE(landing.outcome, SearchOutcome::cap) << gap;
    EXPECT_LE(landing.s, 0.25 + 1e-6) << gap;
  }
}

// It falls without an acceleration, and would land after 2.6e302 tau.
TEST(HardStart, ALandingBeyondAllTimeIsNone) {
  Model model;
  model.H = 0.096153846153846159;
  const double u = 3.7580843034835234e-308, g = 5.8310409491468441e-06, g1 = -2.2704557726318621e-308;
  const Flight<double> flight(Mechanics<double>(model), u, TipState{0.74999034839449363, 0.0, u, g, g1});
  const Landing<double> landing = find_landing(model, flight, kHorizon);
  EXPECT_EQ(landing.outcome, SearchOutcome::clear);
  EXPECT_EQ(landing.s, kHorizon);
}

}  // namespace
}  // namespace afm
