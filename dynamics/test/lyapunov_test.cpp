#include "afm/dynamics/lyapunov.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "support/models.h"

namespace afm {
namespace {

// The change of volumes is known from the impacts alone. Two of the hammer's four directions are held.
TEST(Lyapunov, SumsUpToWhatTheRestitutionTakes) {
  for (const ModelKind kind : {ModelKind::oscillator, ModelKind::hammer}) {
    const bool is_free = kind == ModelKind::oscillator;
    for (const double eta : {0.7, 2.0, 2.75, 3.1, 3.4, 5.0}) {
      const Model model = model_with(is_free ? 0.7 : 0.85, 0.1 * eta, kind);
      LyapunovSettings settings;
      settings.duration = 500.0;
      settings.contact_tolerance = 0.0;
      const LyapunovSpectrum s = lyapunov(model, eta, start_at(eta), settings);
      ASSERT_EQ(s.outcome, LyapunovOutcome::measured) << eta;
      ASSERT_EQ(s.rank, is_free ? 4 : 2);
      EXPECT_EQ(s.exponents[2] == -INFINITY, !is_free);
      const double sum = std::accumulate(s.exponents.begin(), s.exponents.begin() + s.rank, 0.0);
      EXPECT_NEAR(sum, s.volume_rate, 1e-8 * (1.0 + std::abs(s.volume_rate))) << name(kind) << ' ' << eta;
    }
  }
}

// A short run of a fixed point with two complex pairs: those of a pair came in the order of their directions.
TEST(Lyapunov, LargestFirst) {
  for (const double eta : {0.0, 1.51, 3.75}) {
    const LyapunovSpectrum s = lyapunov(Model(), eta, start_at(eta));
    ASSERT_EQ(s.outcome, LyapunovOutcome::measured) << eta;
    for (std::size_t i = 1; i < 4; ++i) EXPECT_GE(s.exponents[i - 1], s.exponents[i]) << eta;
  }
}

// Contact has no friction: a slide that never ends keeps volumes. The stiff one was once carried as one Jacobian, which
// ended after 330 tau, and what grew was shared out over all of the time.
TEST(Lyapunov, SumsUpToNothingInContact) {
  Model model;
  model.y0 = -20.0;
  LyapunovSettings settings;
  settings.transient = 50.0;
  for (const double duration : {400.0, 1200.0}) {
    settings.duration = duration;
    const LyapunovSpectrum s = lyapunov(model, 0.5, FreeState{0.5, 0.0, -model.H, 0.0, 0.0}, settings);
    ASSERT_EQ(s.outcome, LyapunovOutcome::measured);
    ASSERT_EQ(s.rank, 2);
    EXPECT_LT(s.events, 10u);  // where it is cut is no event
    EXPECT_NEAR(s.exponents[0] + s.exponents[1], 0.0, 0.01);
    EXPECT_NEAR(s.exponents[0], 0.69, 0.1);
    EXPECT_LT(s.std_errors[0], 0.1);
  }
}

// After an impact that takes all of the gap rate the tip flies on, or rests. It followed an orbit of its own before.
TEST(Lyapunov, OfPlasticImpactsIsTheLimit) {
  for (const double eta : {26.4, 40.5, 78.1}) {
    const LyapunovSpectrum plastic = lyapunov(model_with(0.0, 0.05), eta, start_at(eta));
    const LyapunovSpectrum nearly = lyapunov(model_with(1e-13, 0.05), eta, start_at(eta));
    ASSERT_EQ(plastic.outcome, LyapunovOutcome::measured) << eta;
    EXPECT_EQ(plastic.rank, 3);
    EXPECT_EQ(plastic.volume_rate, -INFINITY);
    for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(plastic.exponents[i], nearly.exponents[i], 0.02) << eta;
  }
}

// How far a neighbour is after a time, in parts of how far it was.
double growth_of(const Tip& tip, const Model& model, double duration) {
  constexpr double kApart = 1e-11;
  TipState start = tip.tip_state();
  Tip here(model, tip.eta(), start);
  start.X += kApart;
  Tip there(model, tip.eta(), start);
  const ModelTime end = ModelTime{} + duration;
  for (Tip* t : {&here, &there}) {
    while (t->advance(end) != Outcome::time_limit) continue;
  }
  const Deflection a = here.deflection(end), b = there.deflection(end);
  const double du = here.tip_state().u - there.tip_state().u;
  return std::hypot(std::hypot(a.lateral - b.lateral, a.vertical - b.vertical), du / 40.0) / kApart;
}

// Two neighbours on the attractor part at the largest exponent: no Jacobian in it. Fresh displacements need a few
// impacts to turn, so what counts is the growth from 4 tau to 8.
TEST(Lyapunov, IsHowFastNeighboursPart) {
  const Model model = model_with_cutoff(0.34);
  const LyapunovSpectrum s = lyapunov(model, 3.4, start_at(3.4));
  Tip tip(model, 3.4, start_at(3.4));
  double growth = 0.0;
  constexpr int kSpans = 4000;
  for (int i = 1; i <= kSpans; ++i) {
    while (tip.advance({200 + 4 * i, 0.0}) != Outcome::time_limit) continue;
    growth += std::log(growth_of(tip, model, 8.0) / growth_of(tip, model, 4.0));
  }
  EXPECT_NEAR(growth / (4.0 * kSpans), s.exponents[0], 0.06);
  EXPECT_NEAR(s.exponents[0], 0.6, 0.1);
}

// On a chaotic orbit.
TEST(Lyapunov, TheErrorIsTheScatterFromStartToStart) {
  constexpr int kStarts = 100;
  LyapunovSettings settings;
  settings.transient = 50.0;
  settings.duration = 1000.0;
  double sum = 0.0, squares = 0.0, error = 0.0;
  for (int i = 0; i < kStarts; ++i) {
    const FreeState start{0.25, 0.001 * i, 0.2, 3.4, 0.0};
    const LyapunovSpectrum s = lyapunov(model_with_cutoff(0.34), 3.4, start, settings);
    sum += s.exponents[0];
    squares += s.exponents[0] * s.exponents[0];
    error += s.std_errors[0] / kStarts;
  }
  const double scatter = std::sqrt((squares - sum * sum / kStarts) / (kStarts - 1));
  EXPECT_NEAR(scatter / error, 1.0, 0.25);
}

// The exponents do not depend on the contact tolerance. The first case compares with every bounce by itself, where
// chatter sequences are rare. The second compares with a hundredth of the tolerance, where many begin above the cutoff.
TEST(Lyapunov, DoesNotDependOnTheToleranceOfBursts) {
  const double cases[][3] = {{3.4, 0.1, 0.0}, {5.0, 0.01, 1e-5}};
  for (const auto& [eta, v_c, tolerance] : cases) {
    LyapunovSettings coarse, fine;
    coarse.duration = fine.duration = 4000.0;
    fine.contact_tolerance = tolerance;
    const LyapunovSpectrum a = lyapunov(model_with_cutoff(v_c), eta, start_at(eta), coarse);
    const LyapunovSpectrum b = lyapunov(model_with_cutoff(v_c), eta, start_at(eta), fine);
    ASSERT_EQ(a.outcome, LyapunovOutcome::measured);
    ASSERT_EQ(b.outcome, LyapunovOutcome::measured);
    EXPECT_GT(a.exponents[0], 0.1) << eta;
    EXPECT_NEAR(a.exponents[0], b.exponents[0], 4.0 * std::hypot(a.std_errors[0], b.std_errors[0])) << eta;
    EXPECT_NEAR(a.exponents[1], b.exponents[1], 4.0 * std::hypot(a.std_errors[1], b.std_errors[1])) << eta;
  }
}

TEST(Lyapunov, AcrossContactTwoDirectionsAreLost) {
  const Model model = model_with_cutoff(0.02);
  const LyapunovSpectrum s = lyapunov(model, 3.0, start_at(3.0));
  ASSERT_EQ(s.outcome, LyapunovOutcome::measured);
  EXPECT_EQ(s.rank, 2);
  EXPECT_EQ(s.exponents[2], -INFINITY);
  EXPECT_EQ(s.volume_rate, -INFINITY);
  EXPECT_LT(s.exponents[0], 0.0);  // a periodic attractor
}

// A Jacobian that was no number once passed as measured here: its law lost a fixed part of v below the cutoff too.
TEST(Lyapunov, IsANumberWhereBurstsBeginAboveTheCutoff) {
  LyapunovSettings settings;
  settings.duration = 1000.0;
  for (const double v_c : {0.003, 0.01, 0.02}) {
    for (const double eta : {2.95, 4.7, 5.0, 6.95, 9.0}) {
      const LyapunovSpectrum s = lyapunov(model_with_cutoff(v_c), eta, start_at(eta), settings);
      ASSERT_EQ(s.outcome, LyapunovOutcome::measured) << eta << ", cutoff " << v_c;
      EXPECT_FALSE(std::isnan(s.exponents[0])) << eta << ", cutoff " << v_c;
    }
  }
}

TEST(Lyapunov, TellsWhenItsBudgetIsSpent) {
  LyapunovSettings settings;
  settings.most_events = 10;  // before the measurement
  const LyapunovSpectrum none = lyapunov(model_with_cutoff(0.34), 3.4, start_at(3.4), settings);
  EXPECT_EQ(none.outcome, LyapunovOutcome::budget_spent);
  EXPECT_TRUE(std::isnan(none.exponents[0]) && std::isnan(none.std_errors[0]) && std::isnan(none.volume_rate));
  settings.transient = 0.0;
  const LyapunovSpectrum part = lyapunov(model_with_cutoff(0.34), 3.4, start_at(3.4), settings);
  EXPECT_EQ(part.outcome, LyapunovOutcome::budget_spent);
  EXPECT_TRUE(std::isfinite(part.exponents[0]) && std::isnan(part.std_errors[0]));
}

// On the orbit of even eta both multipliers are gamma, over half a tau.
TEST(Lyapunov, OfTheHammerAtEvenEtaIsThatOfTheRestitution) {
  const LyapunovSpectrum s = lyapunov(hammer(0.7, 0.05), 4.0, start_at(4.0));
  EXPECT_NEAR(s.exponents[0], 2.0 * std::log(0.7), 1e-6);
  EXPECT_NEAR(s.exponents[1], 2.0 * std::log(0.7), 1e-6);
}

// In contact the hammer has no freedom left.
TEST(Lyapunov, OfTheHammerAfterContactNothingIsLeft) {
  const LyapunovSpectrum s = lyapunov(hammer(0.7, 1.4), 7.0, start_at(7.0));
  ASSERT_EQ(s.outcome, LyapunovOutcome::measured);
  EXPECT_EQ(s.rank, 0);
  EXPECT_EQ(s.exponents[0], -INFINITY);
  EXPECT_EQ(s.volume_rate, -INFINITY);
}

}  // namespace
}  // namespace afm
