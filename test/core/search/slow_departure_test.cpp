// Flights that hardly leave the surface, as after a contact episode: springs and surface are nearly in balance. Where
// the springs are stretched far, the tip may become a hundred times faster than it is.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "afm/landing.h"
#include "trials/quad.h"
#include "trials/random_launches.h"

namespace afm {
namespace {

constexpr double kHorizon = 4.0;
const Model kMica;
const SpringConstants<double> kSpringConstants(kMica);
const SpringConstants<Quad> kQuadSpringConstants(kMica);

struct Departure {
  double eta;
  TipState start;
};

// A gap rate of 1e-9 to 1e-1 a/tau, and what is left of the balance 1e-6 to 10 a/tau^2 either way.
class Departures {
 public:
  explicit Departures(unsigned seed) : random_(seed) {}

  Departure next() {
    for (;;) {
      const double eta = random_.sign() * random_.power(-1.0, 1.3), u = random_.sign() * random_.power(-1.0, 2.0);
      const double phase = random_.within(0.0, 1.0);
      TipState start{phase, 0.0, u, 0.0, random_.power(-9.0, -1.0)};
      const double at_rest = pull(eta, start);
      start.X = 1.0;
      const double per_a = pull(eta, start) - at_rest;  // the pull is linear in the extension
      start.X = (random_.sign() * random_.power(-6.0, 1.0) - at_rest) / per_a;
      if (std::abs(start.X) < 100.0) return {eta, start};
    }
  }

 private:
  static double pull(double eta, const TipState& start) {
    return Flight<double>(kSpringConstants, eta, start).start().g2;
  }

  RandomLaunches random_;
};

// In quad precision, from a millionth of the flight to all but a millionth of it.
double lowest_gap(const Flight<Quad>& flight, const Quad& end) {
  constexpr int kTimes = 150;
  Quad lowest = 1.0;
  for (int i = 1; i <= kTimes; ++i) {
    const double part = static_cast<double>(i) / kTimes, early = std::pow(10.0, 6.0 * (part - 1.0)) * (1.0 - 1e-6);
    lowest = std::min({lowest, flight.gap(end * early).g, flight.gap(end * part * (1.0 - 1e-6)).g});
  }
  return static_cast<double>(lowest);
}

TEST(SlowDeparture, NothingLiesBeforeTheImpact) {
  Departures departures(3);
  int landed = 0;
  for (int i = 0; i < 1200; ++i) {
    const Departure d = departures.next();
    const Landing<double> landing = find_landing(kMica, Flight<double>(kSpringConstants, d.eta, d.start), kHorizon);
    ASSERT_TRUE(landing.outcome == SearchOutcome::impact || landing.outcome == SearchOutcome::clear);
    const Flight<Quad> exact(kQuadSpringConstants, d.eta, d.start);
    ASSERT_GT(lowest_gap(exact, landing.s), 0.0) << d.eta << " " << d.start.phase << " " << d.start.X;
    if (landing.outcome != SearchOutcome::impact) continue;
    ++landed;
    ASSERT_LT(abs(exact.gap(landing.s).g), 1e-10) << d.eta << " " << d.start.phase << " " << d.start.X;
  }
  EXPECT_GT(landed, 1000);
}

// The bounds of the whole flight are far off at first: the certified time doubles with each evaluation.
TEST(SlowDeparture, AStretchedTipTakesSomeTensOfEvaluations) {
  Departures departures(4);
  int looks = 0, most = 0, flights = 0;
  while (flights < 2000) {
    const Departure d = departures.next();
    const Flight<double> flight(kSpringConstants, d.eta, d.start);
    if (std::abs(d.start.X) < 3.0 || !(flight.start().g3 > 0.0)) continue;
    const Landing<double> landing = find_landing(kMica, flight, kHorizon);
    ++flights, looks += landing.evaluations, most = std::max(most, landing.evaluations);
  }
  EXPECT_LT(looks, 30 * flights);
  EXPECT_LT(most, 100);
}

}  // namespace
}  // namespace afm
