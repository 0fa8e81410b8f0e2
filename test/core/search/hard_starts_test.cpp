// Starts on which a search is hard put to it, most of which it once failed on: loose and stiff springs, forces in
// balance, the glide, speeds and gaps below all rounding.
#include <gtest/gtest.h>

#include <cmath>

#include "afm/impact_search.h"
#include "trials/random_launches.h"

namespace afm {
namespace {

constexpr double kHorizon = 8.0;
constexpr double kEps = 2.220446049250313e-16;

// The inverse of such a gap rate is no number, nor is any step made of it: what is left is to halve the interval.
TEST(HardStart, AFallTooSlowToBeInvertedLands) {
  Model model;
  model.frequency_ratio = 450.98094653157005;
  const TipState start{0.25, 0.0, 0.0, 1.9633695594121459e-314, -3.0237901138519302e-312};
  const Landing<double> landing = find_landing(model, Flight<double>(Mechanics<double>(model), 0.0, start), kHorizon);
  EXPECT_EQ(landing.outcome, SearchOutcome::impact);
  EXPECT_NEAR(landing.s, start.g / -start.g1, 1e-4);
  EXPECT_LT(landing.jet.g1, 0.0);
}

// Stretched over a thousand cells the spring lets the tip creep, where at its fastest it would race: the search, begun
// in more digits at the end of a slide, must not take the steps of a race.
TEST(HardStart, ATipThatCreepsOnALooseSpringComesToAnEnd) {
  Model model;
  model.frequency_ratio = 0.001;
  model.H = 9.8047064352176871;
  const TipState start{0.25049950842403212, 496.4833117208226, 0.07782234564982124, 0.0, 0.0};
  const Flight<double> flight(Mechanics<double>(model), -1000.0, start);
  const Landing<double> landing = find_landing(model, flight, kHorizon);
  ASSERT_EQ(landing.outcome, SearchOutcome::impact);
  EXPECT_LT(std::abs(landing.jet.g), 1e-12);
  constexpr int kSamples = 100000;
  for (int i = 1; i < kSamples; ++i) {
    const double s = landing.s * i / kSamples;
    ASSERT_GT(flight.gap(s).g, -flight.gap_error(s)) << s;
  }
}

// A hair above the surface, where springs and surface hold each other to the last digit: what the search sees there in
// twice the digits must not be bounded by what it sees in one.
TEST(HardStart, WhereAllForcesCancelEndsAtTheHorizon) {
  Model model;
  model.frequency_ratio = 450.98094653157005;
  for (const double eta : {0.0, 6.028798081552414e-312, 3.7580843034835234e-308, 1e-150, 1e-20}) {
    const TipState start{0.74999999999999967, 0.0, eta, 2.0122318257742107e-16, -0.604152 * eta};
    const Landing<double> landing = find_landing(model, Flight<double>(Mechanics<double>(model), eta, start), kHorizon);
    EXPECT_EQ(landing.outcome, SearchOutcome::clear) << eta;
    EXPECT_EQ(landing.s, kHorizon) << eta;
    EXPECT_NEAR(landing.jet.g, start.g, 1e-18) << eta;
  }
}

// Left at rest on the floor of a valley the spring lifts the tip, which is back on the floor after a turn, and touches
// it: steps towards a gap that is half rounding would never get there.
TEST(HardStart, AGrazeOfTheFloorItRoseFromComesToAnEnd) {
  Model model;
  model.H = 10.0;
  const TipState start{0.50000273558322672, 0.0, 0.0, 0.0, 0.0};
  const Landing<double> landing = find_landing(model, Flight<double>(Mechanics<double>(model), 0.0, start), kHorizon);
  ASSERT_EQ(landing.outcome, SearchOutcome::impact);
  EXPECT_NEAR(landing.s, 1.0, 1e-15);
  EXPECT_LT(std::abs(landing.jet.g1), 1e-12);
}

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
    for (const double g1 : {1e-7, 1e-15, 1e-22}) {
      const Flight<double> flight(mechanics, -1.0, TipState{0.25591284509951961, 0.0, -1.0, 0.0, g1});
      const Landing<double> landing = find_landing(model, flight, kSearchHorizon);
      ASSERT_EQ(landing.outcome, SearchOutcome::impact) << g1;
      EXPECT_NEAR(landing.s, 0.5, 1e-6) << g1;
    }
  }
}

// On the glide the gap swings like a spring by itself, also where it is a hundredth of what places are rounded with.
TEST(HardStart, OnTheGlideAGapBelowAllRoundingEndsWhereItsSwingDoes) {
  Model model;
  model.frequency_ratio = 554.11654911257108;
  const TipState start{0.5, 0.0, -1.0, 1.3877787807814457e-17, -5.7046045342847535e-17};
  const Landing<double> landing = find_landing(model, Flight<double>(Mechanics<double>(model), -1.0, start), kHorizon);
  ASSERT_EQ(landing.outcome, SearchOutcome::impact);
  EXPECT_NEAR(landing.s, std::atan(-kTwoPi * start.g / start.g1) / kTwoPi, 1e-9);
}

// Found by fuzzing: the surface shakes below at 936 turns a tau, 3300 looks each. As far as they come nothing is hit.
TEST(HardStart, AFlightOfTooManyLooksIsClearAsFarAsTheyCome) {
  Model shaken;
  shaken.H = 5.3309067632448643;
  shaken.y0 = 0.0;
  shaken.frequency_ratio = 935.70777915161329;
  const TipState start{0.43561489630232375, 0.069185876982674949, -424.61715691441185, 5.0357812379056721,
                       -5599.8054202421808};
  const Flight<double> flight(Mechanics<double>(shaken), -1.2419887072831295e-14, start);
  const Landing<double> landing = find_landing(shaken, flight, kHorizon);
  EXPECT_EQ(landing.outcome, SearchOutcome::clear);
  EXPECT_GT(landing.s, 1.0);
  EXPECT_GT(landing.jet.g, 0.0);
}

// It moves by 1e-20 a: the slopes that it sees are of that size, not those of the surface. By these it took 9230 looks
// in twice the digits.
TEST(HardStart, ATipThatCreepsOnTheFloorLandsInFewLooks) {
  Model model;
  model.H = 10.0;
  model.y0 = -10.0;
  const TipState start{0.5, -2.504373087363358e-20, -2.5027893591181433e-19, 5.7758781386465366e-41,
                       -2.7987092738099678e-38};
  const Landing<double> landing = find_landing(model, Flight<double>(Mechanics<double>(model), 0.0, start), kHorizon);
  ASSERT_EQ(landing.outcome, SearchOutcome::impact);
  EXPECT_NEAR(landing.s, 0.0013868250508038, 1e-12);
  EXPECT_LT(landing.evaluations, 10);
}

}  // namespace
}  // namespace afm
