// Bounces under a surface that presses, too long to be brief, whose end is certain from how they begin.
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
  RootInterval<double> root;
};

class ShortBounces {
 public:
  explicit ShortBounces(unsigned seed) : launches_(seed) {}

  ShortBounce next() {
    for (;;) {
      const double eta = launches_.sign() * launches_.power(-2.0, 1.2);
      const TipState start = launches_.next(eta, -4.0, 0.5);
      const Flight<double> flight(kMechanics, eta, start);
      if (search_detail::is_brief(flight, search_detail::parabola_length(flight))) continue;
      const RootInterval<double> root = search_detail::root_from_launch(flight);
      if (root.certain) return {eta, start, root};
    }
  }

 private:
  RandomLaunches launches_;
};

// In 113 bits: above the surface up to the interval, below it behind, and falling all the way through.
TEST(ShortBounce, HasOneRootAndThatIsInItsInterval) {
  constexpr int kTimes = 20;
  ShortBounces bounces(11);
  for (int i = 0; i < 2000; ++i) {
    const ShortBounce b = bounces.next();
    const Flight<Quad> exact(kQuadMechanics, b.eta, b.start);
    ASSERT_LT(0.0, b.root.low);
    ASSERT_LT(b.root.low, b.root.high);
    for (int k = 1; k <= kTimes; ++k) {
      const double part = static_cast<double>(k) / kTimes;
      ASSERT_GT(exact.gap(Quad(b.root.low * part)).g, 0.0) << i << " " << part;
      ASSERT_LT(exact.gap(Quad(b.root.low + (b.root.high - b.root.low) * part)).g1, 0.0) << i << " " << part;
    }
    ASSERT_LT(exact.gap(Quad(b.root.high)).g, 0.0) << i;
  }
}

// Times and gap rates to a few ulp of the forces that cancel in them; and no more looks than it takes from there.
TEST(ShortBounce, LandsWhereQuadDoesInFewLooks) {
  constexpr int kFlights = 3000;
  ShortBounces bounces(12);
  int looks = 0;
  for (int i = 0; i < kFlights; ++i) {
    const ShortBounce b = bounces.next();
    const Flight<double> flight(kMechanics, b.eta, b.start);
    const Landing<double> landing = find_landing(kMica, flight, 1.0);
    const Landing<Quad> exact = find_impact(Flight<Quad>(kQuadMechanics, b.eta, b.start), Quad(1.0));
    ASSERT_EQ(landing.outcome, SearchOutcome::impact);
    ASSERT_EQ(exact.outcome, SearchOutcome::impact);
    const double error = static_cast<double>(abs(exact.s - landing.s)), rate = -static_cast<double>(exact.jet.g1);
    const double rounding = 2e-15 * (b.start.g1 + flight.bounds().second * landing.s);  // of the gap rate
    ASSERT_LE(std::abs(landing.jet.g1 + rate), rounding) << i;
    ASSERT_LE(error, 2e-16 * landing.s + rounding / rate * landing.s) << i;
    looks += landing.evaluations;
  }
  EXPECT_LT(looks, 2.5 * kFlights);
}

}  // namespace
}  // namespace afm
