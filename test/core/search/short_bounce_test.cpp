// Bounces under a surface that presses: a few thousandths to an eighth of the fastest turn long.
#include <gtest/gtest.h>

#include <cmath>

#include "afm/impact_search.h"
#include "trials/quad.h"
#include "trials/random_launches.h"

namespace afm {
namespace {

const Model kMica;
const Mechanics<double> kMechanics(kMica);
const Mechanics<Quad> kQuadMechanics(kMica);

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
      const Flight<double> flight(kMechanics, eta, start);
      const double turns = -2.0 * start.g1 / flight.start().g2 * flight.bounds().fastest;  // of the parabola
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
    const Flight<double> flight(kMechanics, b.eta, b.start);
    const Landing<double> landing = find_landing(kMica, flight, 1.0);
    const Landing<Quad> exact = find_impact(Flight<Quad>(kQuadMechanics, b.eta, b.start), Quad(1.0));
    ASSERT_EQ(landing.outcome, SearchOutcome::impact);
    ASSERT_EQ(exact.outcome, SearchOutcome::impact);
    const double error = static_cast<double>(abs(exact.s - landing.s)), rate = -static_cast<double>(exact.jet.g1);
    const double rounding = 5e-15 * (b.start.g1 + flight.bounds().second * landing.s);  // of the gap rate
    ASSERT_LE(std::abs(landing.jet.g1 + rate), rounding) << i;
    ASSERT_LE(error, 2e-16 * landing.s + rounding / rate * landing.s) << i;
    evaluations += landing.evaluations;
  }
  EXPECT_LT(evaluations, 6.0 * kFlights);
}

}  // namespace
}  // namespace afm
