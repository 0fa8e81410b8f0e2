// A command splits the flight, burst or slide under way. One that changes the drag velocity by its last digit must
// change no more than last digits; the present velocity again, nothing.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "afm/tip.h"
#include "support/models.h"
#include "support/slides.h"
#include "trials/random_launches.h"

namespace afm {
namespace {

constexpr double kUlp = 2.220446049250313e-16;
constexpr ModelTime kZero{};

Model model_at(double eta) { return model_with_cutoff(0.1 * std::abs(eta)); }

class Split : public testing::TestWithParam<double> {
 protected:
  double eta() const { return GetParam(); }
  double barely_slower() const { return std::nextafter(eta(), 0.0); }
  double within(double low, double high) { return random_.within(low, high); }
  ModelTime between(const ModelTime& a, const ModelTime& b) { return a + within(0.0, 1.0) * (b - a); }
  // The same tip twice, one of them split.
  Tip split_at(const Tip& tip, const ModelTime& t, double eta) {
    Tip split = tip;
    split.advance_segment(t);
    split.drag(eta);
    return split;
  }

  RandomLaunches random_{1};
};

TEST_P(Split, InAFlightMovesTheTipByTwoUlp) {
  constexpr double kReach = 0.1;  // positions are of this order [a]
  int within_two = 0, all = 0;
  for (int i = 0; i < 5000; ++i) {
    Tip whole(model_at(eta()), eta(), random_.next(eta(), -3.0, 1.0), 0.0);
    const ModelTime landing = whole.segment_end(), command = between(kZero, landing), later = between(command, landing);
    Tip split = split_at(whole, command, barely_slower());
    if (!(later < split.segment_end()) || 4.0 < landing - kZero) continue;
    const Deflection a = whole.deflection(later), b = split.deflection(later);
    const double off = std::max(std::abs(a.vertical - b.vertical), std::abs(a.lateral - b.lateral));
    // held back by an ulp of the velocity as well
    ASSERT_LE(off, 8.0 * kUlp * std::max(1.0, kReach * std::abs(eta()))) << i;
    within_two += off <= 2.0 * kUlp ? 1 : 0;
    ++all;
  }
  EXPECT_GT(all, 1000);
  EXPECT_GT(within_two, 0.95 * all);
}

TEST_P(Split, InASlideMovesTheTipByTheErrorOfItsSteps) {
  constexpr double kErrorOfASlide = 1e-2 * kDefaultContactTolerance;
  int all = 0;
  for (int i = 0; i < 2000; ++i) {
    const detail::SlideState<double> q = random_part(eta(), random_).start();
    Tip whole(Model(), eta(), TipState{wrap_phase(q.phase), q.X, q.u, 0.0, 0.0});
    if (whole.advance_segment(kZero) != Outcome::contact) continue;
    const ModelTime command = between(kZero, whole.segment_end());
    Tip split = split_at(whole, command, barely_slower());
    const ModelTime later = between(command, whole.segment_end());
    Outcome outcome = Outcome::flying;
    while (split.segment_end() < later && outcome == Outcome::flying) outcome = split.advance_segment(later);
    if (outcome == Outcome::released) {  // earlier, where the reaction is zero within the error of h'' u^2
      const double k = kTwoPi, u_error = kErrorOfASlide * k * std::max(1.0, std::abs(eta()));
      whole.advance_segment(split.now());
      const TipState there = whole.tip_state();
      ASSERT_LE(pressure_of(Model(), detail::SlideState<double>{there.phase, there.X, there.u}),
                2.0 * k * k * Model().H * std::max(1.0, std::abs(there.u)) * u_error);
      continue;
    }
    ASSERT_EQ(outcome, Outcome::flying);
    const Deflection a = whole.deflection(later), b = split.deflection(later);
    ASSERT_NEAR(a.vertical, b.vertical, kErrorOfASlide);
    ASSERT_NEAR(a.lateral, b.lateral, kErrorOfASlide);
    ++all;
  }
  EXPECT_GT(all, 1000);
}

// To the next impact that is no chatter.
void advance_to_fast_impact(Tip& tip, double slowest) {
  for (int i = 0; i < 100000; ++i) {
    if (tip.advance({100, 0.0}) == Outcome::time_limit) return;
    if (tip.last_impact().kind == ImpactKind::impact && tip.last_impact().normal_speed > slowest) return;
  }
}

// Burst and split burst may let go at different bounces: they meet again at the next impact that is no chatter.
TEST_P(Split, InABurstChangesItByTheErrorOfItsSteps) {
  std::vector<double> off;
  while (off.size() < 1000) {
    const detail::SlideState<double> q = random_part(eta(), random_).start();
    Tip whole(model_at(eta()), eta(), TipState{wrap_phase(q.phase), q.X, q.u, 0.0, within(1e-4, 8e-3)});
    if (whole.tip_state().g1 != 0.0) continue;  // no burst
    Tip split = split_at(whole, between(kZero, whole.segment_end()), barely_slower());
    advance_to_fast_impact(whole, 0.1);
    advance_to_fast_impact(split, 0.099);
    const TipState a = whole.tip_state(), b = split.tip_state();
    off.push_back(std::max(
        {std::abs(whole.now() - split.now()), std::abs(a.X - b.X), std::abs(a.u - b.u), std::abs(a.g1 - b.g1)}));
  }
  std::sort(off.begin(), off.end());
  // the few that meet the crest differently are further off than any bound
  EXPECT_LE(off[500], 1e-6);
  EXPECT_LE(off[980], 3e-5);
}

TEST_P(Split, ByThePresentVelocityChangesNoBit) {
  Tip whole(model_at(eta()), eta(), start_at(eta())), split = whole;
  for (int i = 0; i < 1000; ++i) {
    const Outcome outcome = whole.advance({100000, 0.0});
    const ModelTime command = between(split.now(), whole.now());
    if (command < whole.now()) {
      ASSERT_EQ(split.advance(command), Outcome::time_limit);
      split.drag(eta());
    }
    ASSERT_EQ(split.advance({100000, 0.0}), outcome);
    ASSERT_TRUE(split.now() == whole.now());
    const TipState a = whole.tip_state(), b = split.tip_state();
    ASSERT_TRUE(a.phase == b.phase && a.X == b.X && a.u == b.u && a.g == b.g && a.g1 == b.g1);
  }
}

INSTANTIATE_TEST_SUITE_P(DragSpeeds, Split, testing::Values(0.2, 0.5, 3.0, -3.4, 9.0, 50.0));

}  // namespace
}  // namespace afm
