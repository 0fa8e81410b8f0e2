#include "afm/flight.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/search/double_double.h"
#include "trials/quad.h"
#include "trials/random_launches.h"

namespace afm {

using namespace detail;

namespace {

const Model kMica;
const SpringConstants<double> kSpringConstants(kMica);
const SpringConstants<Quad> kQuadSpringConstants(kMica);
constexpr double kEps = 2.220446049250313e-16;
constexpr double kDragSpeeds[] = {0.0, 0.2, 1.01, 3.4, -3.4, 9.0, 50.0};

// Speeds of a flight, for tolerances: what u and w reach, and what the gap rate is made of.
double speed_scale(double eta, const Flight<double>& f) {
  const double u = std::abs(eta) + kSpringConstants.omega_h * bounds_of(f).X;
  return u + kSpringConstants.omega_v * bounds_of(f).Y;
}

// The same for accelerations: those of y, of the slope's turning and of x.
double acceleration_scale(double eta, const Flight<double>& f) {
  const double u = std::abs(eta) + kSpringConstants.omega_h * bounds_of(f).X, slope = kTwoPi * kSpringConstants.H;
  return kSpringConstants.omega_v * kSpringConstants.omega_v * bounds_of(f).Y +
         slope * (kTwoPi * u * u + kSpringConstants.omega_h * kSpringConstants.omega_h * bounds_of(f).X);
}

TEST(Flight, TwoHalvesEqualOneWhole) {
  RandomLaunches launches(1);
  for (int i = 0; i < 10000; ++i) {
    const double eta = kDragSpeeds[i % 7], s = launches.within(0.0, 4.0);
    const Flight<double> flight(kSpringConstants, eta, launches.next(eta));
    const TipState whole = flight.tip_state(s);
    const TipState half = flight.tip_state(s / 2.0);
    const TipState halves = Flight<double>(kSpringConstants, eta, half).tip_state(s / 2.0);
    const double few = 40.0 * kEps, speed = speed_scale(eta, flight);
    const double apart = std::abs(halves.phase - whole.phase);
    ASSERT_LE(std::min(apart, 1.0 - apart), few * (1.0 + speed));  // a rounded phase and speed, half the time
    ASSERT_NEAR(halves.X, whole.X, few * (bounds_of(flight).X + speed));
    ASSERT_NEAR(halves.u, whole.u, few * speed * (1.0 + kSpringConstants.omega_h));
    ASSERT_NEAR(halves.g, whole.g, few * (1.0 + speed));
    ASSERT_NEAR(halves.g1, whole.g1, few * (1.0 + speed) * (1.0 + speed));
  }
}

TEST(Flight, ItsGapIsTheGapInQuadWithinItsOwnBound) {
  RandomLaunches launches(3);
  for (int i = 0; i < 20000; ++i) {
    const double eta = kDragSpeeds[i % 7], s = std::pow(10.0, launches.within(-9.0, 1.0));
    const TipState start = launches.next(eta);
    const GapJet<double> jet = Flight<double>(kSpringConstants, eta, start).gap(s);
    const GapJet<Quad> truth = Flight<Quad>(kQuadSpringConstants, eta, start).gap(s);
    const Flight<double> flight(kSpringConstants, eta, start);
    ASSERT_LE(static_cast<double>(abs(jet.g - truth.g)), flight.gap_error(s)) << eta << " " << s;
    const double speed = 1.0 + speed_scale(eta, flight);
    ASSERT_LE(static_cast<double>(abs(jet.g1 - truth.g1)), 20.0 * kEps * speed * speed) << eta << " " << s;
    ASSERT_LE(static_cast<double>(abs(jet.g2 - truth.g2)), 200.0 * kEps * speed * speed * speed) << eta << " " << s;
  }
}

// The rounding of the extension is one of the place on the surface.
TEST(Flight, TheBoundHoldsForASpringThatIsStretchedFar) {
  RandomLaunches launches(4);
  for (int i = 0; i < 20000; ++i) {
    const double eta = kDragSpeeds[i % 7], s = std::pow(10.0, launches.within(-3.0, 0.9));
    const double stretch = std::pow(10.0, launches.within(-1.0, 3.0));
    TipState start = launches.next(eta);
    start.X = launches.within(-stretch, stretch);
    start.u += kSpringConstants.omega_h * launches.within(-stretch, stretch);
    const Flight<double> flight(kSpringConstants, eta, start);
    const GapJet<Quad> truth = Flight<Quad>(kQuadSpringConstants, eta, start).gap(s);
    ASSERT_LE(static_cast<double>(abs(flight.gap(s).g - truth.g)), flight.gap_error(s)) << stretch << " " << s;
  }
}

// A fast tip that leaves a flank along x: h' u and the gap rate nearly cancel in the vertical velocity, whose rounding is
// that of h' u. For the ratios of the levers, in double and in double-double.
TEST(Flight, TheBoundHoldsForALaunchThatHardlyRises) {
  RandomLaunches launches(5);
  const auto worst = [&](double ratio, double eta, double swing) {
    Model model;
    model.frequency_ratio = ratio;
    const SpringConstants<double> springs(model);
    const SpringConstants<Quad> in_quad(model);
    const SpringConstants<DoubleDouble> fine(model);
    double largest = 0.0;
    for (int i = 0; i < 3000; ++i) {
      TipState start = launches.next(eta);
      start.phase = launches.within(0.0, 0.5);
      start.X = launches.within(-swing, swing);
      start.u = eta + springs.omega_h * launches.within(0.0, swing);
      start.g = 0.0;
      start.g1 = launches.within(0.01, 0.3) - surface_jet(model.H, start.phase).h1 * start.u;
      const double s = launches.within(0.0, 8.0);
      const Quad truth = Flight<Quad>(in_quad, eta, start).gap(s).g;
      const Flight<double> flight(springs, eta, start);
      const Flight<DoubleDouble> finer(fine, eta, start);
      largest = std::max(largest, static_cast<double>(abs(flight.gap(s).g - truth)) / flight.gap_error(s));
      largest = std::max(
          largest, static_cast<double>(abs(to_quad(finer.gap(s).g) - truth)) / static_cast<double>(finer.gap_error(s)));
    }
    return largest;
  };
  for (const double ratio : {0.5, 6.25, 14.0, 30.0, 100.0}) {
    for (const double eta : {0.2, 9.0, 100.0}) {
      EXPECT_LT(worst(ratio, eta, 0.01), 1.0) << ratio << ' ' << eta;
      EXPECT_LT(worst(ratio, eta, 0.5), 1.0) << ratio << ' ' << eta;
    }
  }
}

TEST(Flight, NearItsStartTheGapKeepsItsDigits) {
  RandomLaunches launches(4);
  for (int i = 0; i < 20000; ++i) {
    const double eta = kDragSpeeds[i % 7], s = std::pow(10.0, launches.within(-14.0, -2.5));
    const TipState start = launches.next(eta, -10.0, 1.0);
    const GapJet<double> jet = Flight<double>(kSpringConstants, eta, start).gap(s);
    const GapJet<Quad> truth = Flight<Quad>(kQuadSpringConstants, eta, start).gap(s);
    // the gap rate's part and the rest are each right to a few ulp
    const double rest = 0.5 * acceleration_scale(eta, Flight<double>(kSpringConstants, eta, start)) * s * s;
    ASSERT_LE(static_cast<double>(abs(jet.g - truth.g)), 16.0 * kEps * (start.g1 * s + rest)) << eta << " " << s;
  }
}

TEST(Flight, TheFormForSmallTimesIsTheLongForm) {
  RandomLaunches launches(5);
  for (int i = 0; i < 2000; ++i) {
    const double eta = kDragSpeeds[i % 7];
    const Quad s = std::pow(10.0, launches.within(-9.0, -2.0)) / (1.0 + std::abs(eta));
    const Flight<Quad> flight(kQuadSpringConstants, eta, launches.next(eta));
    const GapJet<Quad> small = flight.gap(s);
    const FlightState<Quad> far = flight.at(s);
    const SurfaceJet<Quad> surface = surface_jet(kQuadSpringConstants.H, far.phase);
    ASSERT_LE(static_cast<double>(abs(small.g - (far.Y + kQuadSpringConstants.y0 - surface.h))), 1e-32);
    ASSERT_LE(static_cast<double>(abs(small.g1 - (far.W - surface.h1 * (eta + far.U)))), 1e-28);
    ASSERT_LE(static_cast<double>(abs(small.state.phase - far.phase)), 1e-32);
    ASSERT_LE(static_cast<double>(abs(small.state.X - far.X)), 1e-32);
    ASSERT_LE(static_cast<double>(abs(small.state.Y - far.Y)), 1e-32);
  }
}

TEST(Flight, EachDerivativeIsTheSlopeOfTheOneBefore) {
  RandomLaunches launches(7);
  const Quad step(1e-13);
  for (int i = 0; i < 1000; ++i) {
    const double eta = kDragSpeeds[i % 7];
    const Flight<Quad> flight(kQuadSpringConstants, eta, launches.next(eta));
    const Quad s = launches.within(1e-4, 3.0);
    const GapJet<Quad> up = flight.gap(s + step), here = flight.gap(s), down = flight.gap(s - step);
    const double scale = static_cast<double>(bounds_of(flight).third);
    ASSERT_LE(static_cast<double>(abs((up.g - down.g) / (2 * step) - here.g1)), 1e-17 * scale) << eta;
    ASSERT_LE(static_cast<double>(abs((up.g1 - down.g1) / (2 * step) - here.g2)), 1e-14 * scale) << eta;
  }
}

// Also of tips that are stretched far.
TEST(Flight, ThirdAndFourthDerivativeStayWithinTheirBounds) {
  RandomLaunches launches(8);
  const Quad step(1e-10);
  double third = 0.0, fourth = 0.0;  // the largest share of its bound
  for (int i = 0; i < 400; ++i) {
    const double eta = kDragSpeeds[i % 7];
    TipState start = launches.next(eta);
    if (i % 2 == 0) start.X = launches.within(-12.0, 12.0);
    const Flight<Quad> flight(kQuadSpringConstants, eta, start);
    const auto bounds = bounds_of(flight);
    for (int k = 0; k <= 200; ++k) {
      const Quad s = Quad(k) * Quad(0.011);
      const GapJet<Quad> up = flight.gap(s + step), down = flight.gap(s - step);
      third = std::max(third, static_cast<double>(abs(up.g2 - down.g2) / (2 * step) / bounds.third));
      fourth = std::max(fourth, static_cast<double>(abs(up.g3 - down.g3) / (2 * step) / bounds.fourth));
      ASSERT_LE(third, 1.0) << eta << " " << s;
      ASSERT_LE(fourth, 1.0 + 1e-6) << eta << " " << s;
    }
  }
  EXPECT_GT(std::min(third, fourth), 0.3) << "a bound so loose would make the search slow";
}

}  // namespace
}  // namespace afm
