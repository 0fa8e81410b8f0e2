#include "afm_emulator/impact_search.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "quad.h"
#include "random_launches.h"

namespace afm {
namespace {

const Model kMica;
const Mechanics<double> kMechanics(kMica);
const Mechanics<DoubleDouble> kFineMechanics(kMica);
const Mechanics<Quad> kQuadMechanics(kMica);
constexpr double kHorizon = 8.0;
constexpr double kEps = 2.220446049250313e-16;

double to_double(const Quad& x) { return static_cast<double>(x); }

double speed_scale(const Flight<double>& f) {
  return std::abs(f.eta()) + kMechanics.omega_h * f.amplitude_X() + kMechanics.omega_v * f.amplitude_Y();
}

// How far rounding the flight to T may move a landing.
template <class T>
double condition(const Flight<double>& f, const Landing<Quad>& landing) {
  const double scale = (1.0 + speed_scale(f)) * (1.0 + speed_scale(f)), s = to_double(landing.s);
  const double eps = static_cast<double>(epsilon<T>());
  return 20.0 * eps * scale * (s / f.start().g1 + 1.0 / -to_double(landing.jet.g1));
}

// The lowest gap between two times around a minimum, from its rate.
double lowest_gap(const Flight<double>& f, double from, double to) {
  for (int i = 0; i < 50; ++i) {
    const double middle = 0.5 * (from + to);
    (f.gap(middle).g1 < 0.0 ? from : to) = middle;
  }
  return f.gap(from).g + f.gap_error(from);
}

// Samples the whole flight densely, and looks into every dip between samples.
bool penetrates(const Flight<double>& f, double until) {
  const double step = std::min(0.01 / (1.0 + speed_scale(f)), until / 50.0);
  GapJet<double> before = f.start();
  double s = 0.0;
  for (double t = step; t < until; t += step) {
    const GapJet<double> jet = f.gap(t);
    if (jet.g < -f.gap_error(t)) return true;
    if (before.g1 < 0.0 && jet.g1 > 0.0 && lowest_gap(f, s, t) < 0.0) return true;
    before = jet;
    s = t;
  }
  return false;
}

class ImpactSearchAtEta : public testing::TestWithParam<double> {};

TEST_P(ImpactSearchAtEta, NoImpactIsMissedAndNoneInvented) {
  RandomLaunches launches(1);
  const double eta = GetParam();
  int impacts = 0;
  for (int i = 0; i < 1000; ++i) {
    const TipState start = launches.next(eta);
    const Flight<double> flight(kMechanics, eta, start);
    const Landing<double> landing = find_landing(kMica, flight, kHorizon);
    ASSERT_TRUE(landing.outcome == SearchOutcome::impact || landing.outcome == SearchOutcome::clear);
    const double s = landing.s;
    ASSERT_FALSE(penetrates(flight, s * (1.0 - 1e-6))) << "flight " << i << " landed at " << s;
    if (landing.outcome == SearchOutcome::clear) continue;
    ++impacts;
    const GapJet<Quad> there = Flight<Quad>(kQuadMechanics, eta, start).gap(s);
    ASSERT_LE(std::abs(to_double(there.g)), flight.gap_error(s) + kEps * s * std::abs(to_double(there.g1))) << i;
    ASSERT_LT(landing.jet.g1, 0.0) << i;
  }
  EXPECT_GT(impacts, 700);
}

TEST_P(ImpactSearchAtEta, IsTheSameInDoubleInTwiceTheDigitsAndInQuad) {
  RandomLaunches launches(2);
  const double eta = GetParam();
  for (int i = 0; i < 300; ++i) {
    const TipState start = launches.next(eta);
    const Flight<double> flight(kMechanics, eta, start);
    const Landing<Quad> truth = find_impact(Flight<Quad>(kQuadMechanics, eta, start), Quad(kHorizon));
    const Landing<DoubleDouble> fine =
        find_impact(Flight<DoubleDouble>(kFineMechanics, eta, start), DoubleDouble(kHorizon));
    const Landing<double> landing = find_landing(kMica, flight, kHorizon);
    ASSERT_EQ(truth.outcome, fine.outcome) << i;
    ASSERT_EQ(truth.outcome, landing.outcome) << i;
    if (truth.outcome != SearchOutcome::impact) continue;
    EXPECT_LE(to_double(abs(to_quad(fine.s) - truth.s)), condition<DoubleDouble>(flight, truth)) << i;
    EXPECT_LE(to_double(abs(landing.s - truth.s)), condition<double>(flight, truth)) << i;
  }
}

TEST_P(ImpactSearchAtEta, AHorizonBeforeTheImpactIsReachedOrTheImpactIsSeenBeyondIt) {
  RandomLaunches launches(3);
  const double eta = GetParam();
  int cleared = 0;
  for (int i = 0; i < 300; ++i) {
    const Flight<double> flight(kMechanics, eta, launches.next(eta));
    const Landing<double> landing = find_landing(kMica, flight, kHorizon);
    const double early = landing.s * launches.within(0.0, 0.999);
    const Landing<double> cut = find_landing(kMica, flight, early);
    if (cut.outcome == SearchOutcome::clear) {
      ++cleared;
      ASSERT_EQ(cut.s, early) << i;
    } else {
      ASSERT_EQ(cut.outcome, SearchOutcome::impact) << i;
      ASSERT_NEAR(cut.s, landing.s, 1e-9) << i;
    }
  }
  EXPECT_GT(cleared, 50);
}

INSTANTIATE_TEST_SUITE_P(DragSpeeds, ImpactSearchAtEta, testing::Values(0.0, 0.2, 1.01, -3.4, 3.4, 9.0, 50.0));

// The inverse of such a gap rate is no number, nor is any step made of it: what is left is to halve the interval.
TEST(ImpactSearch, AFallTooSlowToBeInvertedLands) {
  Model model;
  model.frequency_ratio = 450.98094653157005;
  const TipState start{0.25, 0.0, 0.0, 1.9633695594121459e-314, -3.0237901138519302e-312};
  const Landing<double> landing = find_landing(model, Flight<double>(Mechanics<double>(model), 0.0, start), kHorizon);
  EXPECT_EQ(landing.outcome, SearchOutcome::impact);
  EXPECT_NEAR(landing.s, start.g / -start.g1, 1e-4);
  EXPECT_LT(landing.jet.g1, 0.0);
}

// Of fast launches and of chatter, as the tip leaves bounds for later.
TEST(ImpactSearch, BoundsThatAreLeftForLaterChangeNothing) {
  RandomLaunches launches(8);
  for (int i = 0; i < 2000; ++i) {
    const double eta = launches.within(-9.0, 9.0);
    const TipState start = i % 2 == 0 ? launches.next(eta) : launches.next(eta, -6.0, -1.0);
    const Landing<double> known = find_landing(kMica, Flight<double>(kMechanics, eta, start), kHorizon);
    Flight<double> flight(kMechanics, eta, start, BoundLater{});
    const Landing<double> later = find_landing(kMica, flight, kHorizon);
    ASSERT_EQ(later.outcome, known.outcome) << i;
    ASSERT_EQ(later.s, known.s) << i;
    ASSERT_EQ(later.jet.g1, known.jet.g1) << i;
  }
}

TEST(ImpactSearch, AMicroBounceIsRightToItsLastDigits) {
  RandomLaunches launches(4);
  int bounces = 0;
  for (int i = 0; i < 5000; ++i) {
    const double eta = launches.within(-9.0, 9.0);
    const TipState start = launches.next(eta, -15.0, -4.0);
    const Flight<double> flight(kMechanics, eta, start);
    if (!(flight.start().g2 < -1.0)) continue;
    ++bounces;
    const Landing<double> landing = find_landing(kMica, flight, kHorizon);
    const Landing<Quad> truth = find_impact(Flight<Quad>(kQuadMechanics, eta, start), Quad(kHorizon));
    ASSERT_EQ(landing.outcome, SearchOutcome::impact);
    ASSERT_GT(landing.s, start.g1 / -flight.start().g2) << "the impact just left was found again";
    // the pressing force is a sum of large terms, and so known to fewer digits than it has
    const double speed = 1.0 + speed_scale(flight);
    const double digits = 10.0 * kEps * (1.0 + 40.0 * speed * speed / -flight.start().g2);
    ASSERT_LE(relative_error(landing.s, truth.s), digits) << i;
    ASSERT_LE(relative_error(landing.jet.g1, truth.jet.g1), digits) << i;
  }
  EXPECT_GT(bounces, 1000);
}

TEST(ImpactSearch, LeavingSlowlyUnderALiftingForceIsNoImpact) {
  RandomLaunches launches(5);
  int lifts = 0;
  for (int i = 0; i < 5000; ++i) {
    const double eta = launches.within(-9.0, 9.0);
    const TipState start = launches.next(eta, -15.0, -8.0);
    const Flight<double> flight(kMechanics, eta, start);
    if (!(flight.start().g2 > 1.0)) continue;
    ++lifts;
    const Landing<double> landing = find_landing(kMica, flight, kHorizon);
    const Landing<Quad> truth = find_impact(Flight<Quad>(kQuadMechanics, eta, start), Quad(kHorizon));
    ASSERT_EQ(landing.outcome, truth.outcome);
    ASSERT_NEAR(landing.s, to_double(truth.s), 1e-9) << i;
  }
  EXPECT_GT(lifts, 1000);
}

// Stretched over a thousand cells the spring lets the tip creep, where at its fastest it would race: the search, begun
// in more digits at the end of a slide, must not take the steps of a race.
TEST(ImpactSearch, OfATipThatCreepsOnALooseSpringComesToAnEnd) {
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
TEST(ImpactSearch, WhereAllForcesCancelEndsAtTheHorizon) {
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
TEST(ImpactSearch, OfAGrazeOfTheFloorItRoseFromComesToAnEnd) {
  Model model;
  model.H = 10.0;
  const TipState start{0.50000273558322672, 0.0, 0.0, 0.0, 0.0};
  const Landing<double> landing = find_landing(model, Flight<double>(Mechanics<double>(model), 0.0, start), kHorizon);
  ASSERT_EQ(landing.outcome, SearchOutcome::impact);
  EXPECT_NEAR(landing.s, 1.0, 1e-15);
  EXPECT_LT(std::abs(landing.jet.g1), 1e-12);
}

// Its stiff spring turns within the interval that holds the root, where no series of the gap converges.
TEST(ImpactSearch, OfATipOnAStiffSpringEndsOnTheSurface) {
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

// A reflection turns velocities round by it, and takes no sine.
TEST(ImpactSearch, ComesWithTheSlopeOfTheSurfaceWhereItEnds) {
  for (const double ratio : {0.01, 6.25, 1000.0}) {
    Model model;
    model.frequency_ratio = ratio;
    const Mechanics<double> mechanics(model);
    RandomLaunches random(13);
    for (int i = 0; i < 20000; ++i) {
      const double eta = random.within(-9.0, 9.0);
      const TipState start = random.next(eta, i % 2 == 0 ? -6.0 : -2.0, 1.0);
      const Landing<double> landing = find_landing(model, Flight<double>(mechanics, eta, start), kHorizon);
      if (landing.outcome != SearchOutcome::impact) continue;
      const Quad slope = surface_jet(Quad(model.H), Quad(landing.jet.state.phase)).h1;
      const double place = std::max(1.0, std::abs(landing.jet.state.phase));  // it is rounded too
      ASSERT_NEAR(landing.jet.h1, to_double(slope), kEps * (4.0 + kTwoPi * place) * kTwoPi * model.H) << i;
    }
  }
}

// There the gap swings by itself, however little, and what it swings by may be far below the rounding of places.
TEST(ImpactSearch, OnTheGlideALaunchHoweverSlowLandsHalfATurnLater) {
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
TEST(ImpactSearch, OnTheGlideAGapBelowAllRoundingEndsWhereItsSwingDoes) {
  Model model;
  model.frequency_ratio = 554.11654911257108;
  const TipState start{0.5, 0.0, -1.0, 1.3877787807814457e-17, -5.7046045342847535e-17};
  const Landing<double> landing = find_landing(model, Flight<double>(Mechanics<double>(model), -1.0, start), kHorizon);
  ASSERT_EQ(landing.outcome, SearchOutcome::impact);
  EXPECT_NEAR(landing.s, std::atan(-kTwoPi * start.g / start.g1) / kTwoPi, 1e-9);
}

TEST(ImpactSearch, AStartInTheAirIsAStartLikeAnyOther) {
  RandomLaunches launches(6);
  for (int i = 0; i < 1000; ++i) {
    const double eta = launches.within(-9.0, 9.0);
    TipState start = launches.next(eta, -3.0, 1.0);
    start.g = launches.within(1e-6, 0.5);
    if (i % 2 == 0) start.g1 = -start.g1;
    const Flight<double> flight(kMechanics, eta, start);
    const Landing<double> landing = find_landing(kMica, flight, kHorizon);
    const Landing<Quad> truth = find_impact(Flight<Quad>(kQuadMechanics, eta, start), Quad(kHorizon));
    ASSERT_EQ(landing.outcome, truth.outcome);
    ASSERT_NEAR(landing.s, to_double(truth.s), 1e-9) << i;
    ASSERT_FALSE(penetrates(flight, landing.s * (1.0 - 1e-6))) << i;
  }
}

// Found by fuzzing: the surface shakes below at 936 turns a tau, 3300 looks each. As far as they come nothing is hit.
TEST(ImpactSearch, AFlightOfTooManyLooksIsClearAsFarAsTheyCome) {
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

}  // namespace
}  // namespace afm
