#include "core/search/impact_search.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "trials/quad.h"
#include "trials/random_launches.h"

namespace afm {

using namespace detail;

namespace {

const Model kMica;
const SpringConstants<double> kSpringConstants(kMica);
const SpringConstants<DoubleDouble> kFineSpringConstants(kMica);
const SpringConstants<Quad> kQuadSpringConstants(kMica);
constexpr double kHorizon = 8.0;
constexpr double kEps = 2.220446049250313e-16;

double to_double(const Quad& x) { return static_cast<double>(x); }

double speed_scale(const Flight<double>& f) {
  return std::abs(f.eta()) + kSpringConstants.omega_h * bounds_of(f).X + kSpringConstants.omega_v * bounds_of(f).Y;
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
    const Flight<double> flight(kSpringConstants, eta, start);
    const Landing<double> landing = find_landing(kMica, flight, kHorizon);
    ASSERT_TRUE(landing.outcome == SearchOutcome::impact || landing.outcome == SearchOutcome::clear);
    const double s = landing.s;
    ASSERT_FALSE(penetrates(flight, s * (1.0 - 1e-6))) << "flight " << i << " landed at " << s;
    if (landing.outcome == SearchOutcome::clear) continue;
    ++impacts;
    const GapJet<Quad> there = Flight<Quad>(kQuadSpringConstants, eta, start).gap(s);
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
    const Flight<double> flight(kSpringConstants, eta, start);
    const Landing<Quad> truth = find_impact(Flight<Quad>(kQuadSpringConstants, eta, start), Quad(kHorizon));
    const Landing<DoubleDouble> fine =
        find_impact(Flight<DoubleDouble>(kFineSpringConstants, eta, start), DoubleDouble(kHorizon));
    const Landing<double> landing = find_landing(kMica, flight, kHorizon);
    ASSERT_EQ(truth.outcome, fine.outcome) << i;
    ASSERT_EQ(truth.outcome, landing.outcome) << i;
    if (truth.outcome != SearchOutcome::impact) continue;
    EXPECT_LE(to_double(abs(to_quad(fine.s) - truth.s)), condition<DoubleDouble>(flight, truth)) << i;
    EXPECT_LE(to_double(abs(landing.s - truth.s)), condition<double>(flight, truth)) << i;
  }
}

INSTANTIATE_TEST_SUITE_P(DragSpeeds, ImpactSearchAtEta, testing::Values(0.0, 0.2, 1.01, -3.4, 3.4, 9.0, 50.0));

TEST(ImpactSearch, AMicroBounceIsRightToItsLastDigits) {
  RandomLaunches launches(4);
  int bounces = 0;
  for (int i = 0; i < 5000; ++i) {
    const double eta = launches.within(-9.0, 9.0);
    const TipState start = launches.next(eta, -15.0, -4.0);
    const Flight<double> flight(kSpringConstants, eta, start);
    if (!(flight.start().g2 < -1.0)) continue;
    ++bounces;
    const Landing<double> landing = find_landing(kMica, flight, kHorizon);
    const Landing<Quad> truth = find_impact(Flight<Quad>(kQuadSpringConstants, eta, start), Quad(kHorizon));
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

// A reflection turns velocities round by it, and takes no sine.
TEST(ImpactSearch, ComesWithTheSlopeOfTheSurfaceWhereItEnds) {
  for (const double ratio : {0.01, 6.25, 1000.0}) {
    Model model;
    model.frequency_ratio = ratio;
    const SpringConstants<double> springs(model);
    RandomLaunches random(13);
    for (int i = 0; i < 20000; ++i) {
      const double eta = random.within(-9.0, 9.0);
      const TipState start = random.next(eta, i % 2 == 0 ? -6.0 : -2.0, 1.0);
      const Landing<double> landing = find_landing(model, Flight<double>(springs, eta, start), kHorizon);
      if (landing.outcome != SearchOutcome::impact) continue;
      const Quad slope = surface_jet(Quad(model.H), Quad(landing.jet.state.phase)).h1;
      const double place = std::max(1.0, std::abs(landing.jet.state.phase));  // it is rounded too
      ASSERT_NEAR(landing.jet.h1, to_double(slope), kEps * (4.0 + kTwoPi * place) * kTwoPi * model.H) << i;
    }
  }
}

// Under a surface that presses: a few thousandths to an eighth of the fastest turn long.
struct ShortBounce {
  double eta;
  TipState start;
};

class ShortBounces {
 public:
  explicit ShortBounces(unsigned seed) : launches_(seed) {}

  ShortBounce next() {
    for (;;) {
      const double eta = launches_.sign() * launches_.power(-2.0, 1.2);
      const TipState start = launches_.next(eta, -4.0, 0.5);
      const Flight<double> flight(kSpringConstants, eta, start);
      const double turns = -2.0 * start.g1 / flight.start().g2 * bounds_of(flight).fastest;  // of the parabola
      if (start.g1 > 0.0 && turns > 0.002 && turns < kSmallTurn) return {eta, start};
    }
  }

 private:
  RandomLaunches launches_;
};

// Times and gap rates to a few ulp of the forces that cancel in them; and in few evaluations.
TEST(ShortBounce, LandsWhereQuadDoesInFewEvaluations) {
  constexpr int kFlights = 3000;
  ShortBounces bounces(12);
  int evaluations = 0;
  for (int i = 0; i < kFlights; ++i) {
    const ShortBounce b = bounces.next();
    const Flight<double> flight(kSpringConstants, b.eta, b.start);
    const Landing<double> landing = find_landing(kMica, flight, 1.0);
    const Landing<Quad> exact = find_impact(Flight<Quad>(kQuadSpringConstants, b.eta, b.start), Quad(1.0));
    ASSERT_EQ(landing.outcome, SearchOutcome::impact);
    ASSERT_EQ(exact.outcome, SearchOutcome::impact);
    const double error = static_cast<double>(abs(exact.s - landing.s)), rate = -static_cast<double>(exact.jet.g1);
    const double rounding = 5e-15 * (b.start.g1 + bounds_of(flight).second * landing.s);  // of the gap rate
    ASSERT_LE(std::abs(landing.jet.g1 + rate), rounding) << i;
    ASSERT_LE(error, 2e-16 * landing.s + rounding / rate * landing.s) << i;
    evaluations += landing.evaluations;
  }
  EXPECT_LT(evaluations, 6.0 * kFlights);
}

// Its stiff spring turns within the interval that holds the root, where no series of the gap converges.
TEST(HardStart, ATipOnAStiffSpringEndsOnTheSurface) {
  Model model;
  model.frequency_ratio = 1000.0;
  const SpringConstants<double> springs(model);
  RandomLaunches random(12);
  for (int i = 0; i < 20000; ++i) {
    TipState start = random.next(2.0, -2.0, 1.0);
    start.X *= std::pow(10.0, random.within(-6.0, 0.0));
    start.u = 2.0 + random.within(-1.0, 1.0) * springs.omega_h * std::abs(start.X);
    const Flight<double> f(springs, 2.0, start);
    const Landing<double> landing = find_landing(model, f, kHorizon);
    ASSERT_EQ(landing.outcome, SearchOutcome::impact) << i;
    const GapJet<double> there = f.gap(landing.s);
    const double late = 4.0 * kEps * landing.s * (std::abs(there.g1) + springs.omega_h);
    ASSERT_LT(std::abs(there.g), 4.0 * f.gap_error(landing.s) + late) << i;
    ASSERT_NEAR(landing.jet.state.U, there.state.U, 1e-9 * (1.0 + springs.omega_h * bounds_of(f).X)) << i;
  }
}

// There the gap swings by itself, however little, and what it swings by may be far below the rounding of places.
TEST(HardStart, OnTheGlideALaunchHoweverSlowLandsHalfATurnLater) {
  for (const ModelKind kind : {ModelKind::oscillator, ModelKind::hammer}) {
    Model model;
    model.kind = kind;
    const SpringConstants<double> springs(model);
    for (const double g1 : {1e-7, 1e-15}) {
      const Flight<double> flight(springs, -1.0, TipState{0.25591284509951961, 0.0, -1.0, 0.0, g1});
      const Landing<double> landing = find_landing(model, flight, kSearchHorizon);
      ASSERT_EQ(landing.outcome, SearchOutcome::impact) << g1;
      EXPECT_NEAR(landing.s, 0.5, 1e-6) << g1;
    }
  }
}

// On a crest, at this speed, the gap's acceleration is zero and its third derivative is not. Once rounding made a root,
// before the start even.
TEST(HardStart, ALaunchInBalanceFliesHoweverSlowItIs) {
  for (const double X : {0.5, 9.0}) {
    for (double g1 = 1e-12; g1 > 1e-48; g1 *= 0.01) {
      const Flight<double> flight(kSpringConstants, 1.3, TipState{0.0, X, -1.0, 0.0, g1});
      const Landing<double> landing = find_landing(kMica, flight, kHorizon);
      ASSERT_EQ(landing.outcome, SearchOutcome::impact) << g1;
      ASSERT_GT(landing.s, 0.01) << g1;
      ASSERT_LT(landing.jet.g1, 0.0) << g1;
    }
  }
}

// It would land a quarter of a turn later. Until then the gap has only its fourth derivative, so the steps are short.
TEST(HardStart, OnTheGlideAGapHoweverSmallExhaustsNoSearch) {
  Model model;
  model.kind = ModelKind::hammer;
  model.H = 0.83993305622109515;
  const SpringConstants<double> springs(model);
  for (const double gap : {1e-21, 1.2e-20, 1e-19, 1e-18, 9e-18, 1.1e-17, 1e-16, 1e-14}) {
    const Flight<double> flight(springs, -1.0, TipState{0.53955942957884762, 0.0, -1.0, gap, 0.0});
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
  const Flight<double> flight(SpringConstants<double>(model), u, TipState{0.74999034839449363, 0.0, u, g, g1});
  const Landing<double> landing = find_landing(model, flight, kHorizon);
  EXPECT_EQ(landing.outcome, SearchOutcome::clear);
  EXPECT_EQ(landing.s, kHorizon);
}

}  // namespace
}  // namespace afm
