#include "afm/dynamics/attractor.h"

#include <gtest/gtest.h>

#include <cmath>

#include "afm/dynamics/basins.h"
#include "support/models.h"

namespace afm {
namespace {

Attractor from_above(double eta, double v_c, const AttractorSettings& settings = {}) {
  const Model model = model_with_cutoff(v_c);
  return find_attractor(model, eta, to_tip_state(model.H, start_at(eta)), settings);
}

std::vector<Basin> basins_of(const SweepPoint& point, int starts, double friction_duration) {
  BasinSettings settings;
  settings.starts = starts;
  settings.friction_duration = friction_duration;
  return find_basins(point, settings);
}

TEST(Attractor, PeriodOneLocksToTheSurface) {
  struct Known {
    double eta;
    int cells;
  };
  for (const Known& known : {Known{1.5, 1}, Known{2.0, 1}, Known{2.25, 1}, Known{4.5, 2}}) {
    const Attractor a = from_above(known.eta, 0.1 * known.eta);
    EXPECT_EQ(a.name(), "period-1") << known.eta;
    EXPECT_EQ(a.cells, known.cells);
    EXPECT_LT(a.lyapunov.exponents[0], 0.0);
    EXPECT_NEAR(a.cells_per_impact, known.cells, 0.01);
  }
}

// The exponents of eta = 2, gamma = 0.7: multipliers 0.9195, -0.0723 +- 0.8931 i, 0.6637 over half a tau.
TEST(Attractor, ExponentsOfAPeriodicOrbitAreThoseOfItsMultipliers) {
  const Attractor a = from_above(2.0, 0.2);
  const double expected[] = {std::log(0.91951) / 0.5, std::log(std::hypot(0.072317, 0.89314)) / 0.5,
                             std::log(std::hypot(0.072317, 0.89314)) / 0.5, std::log(0.66369) / 0.5};
  for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(a.lyapunov.exponents[i], expected[i], 1e-4) << i;
  EXPECT_NEAR(a.lyapunov.volume_rate, 4.0 * std::log(0.7), 1e-9);
}

// The area between two neighbours and the tip, after six periods: no Jacobian in it.
TEST(Attractor, AcrossContactAnAreaShrinksByTheSumOfBothExponents) {
  constexpr double kEta = 3.0, kApart = 1e-6;
  const Model model = model_with_cutoff(0.02);
  Tip tip(model, kEta, to_tip_state(model.H, start_at(kEta)));
  const Attractor a = find_attractor(model, tip);
  ASSERT_EQ(a.lyapunov.rank, 2);
  TipState faster = tip.tip_state(), higher = faster;
  faster.u += 40.0 * kApart;
  higher.g1 += 6.0 * kApart;
  Tip tips[] = {{model, kEta, tip.tip_state()}, {model, kEta, faster}, {model, kEta, higher}};
  const auto area_at = [&](const ModelTime& time) {
    double x[3], y[3];
    for (int i = 0; i < 3; ++i) {
      while (tips[i].advance(time) != Outcome::time_limit) continue;
      x[i] = tips[i].deflection(time).lateral, y[i] = tips[i].deflection(time).vertical;
    }
    return (x[1] - x[0]) * (y[2] - y[0]) - (x[2] - x[0]) * (y[1] - y[0]);
  };
  const ModelTime begin{3, 0.0};
  const double periods = 6.0 * a.cells / kEta, before = area_at(begin), after = area_at(begin + periods);
  EXPECT_NEAR(std::log(after / before) / periods, a.lyapunov.exponents[0] + a.lyapunov.exponents[1], 5e-3);
}

// Its first return within the tolerance may be that of four periods.
TEST(Attractor, ATipThatStillConvergesHasThePeriodOfItsOrbit) {
  const Model model = model_with_cutoff(0.2);
  Tip tip(model, 2.0, to_tip_state(model.H, start_at(2.0)));
  ASSERT_EQ(find_attractor(model, tip).name(), "period-1");
  AttractorSettings at_once;
  at_once.transient = 0.0;
  for (double apart = 1e-10; apart < 1e-7; apart *= 1.3) {
    TipState start = tip.tip_state();
    start.u += apart;
    EXPECT_EQ(find_attractor(model, 2.0, start, at_once).name(), "period-1") << apart;
  }
}

// By the spectrum of the run, too. The first goes twice round the centre in each plane, where it goes round once.
TEST(Attractor, ARotationNumberIsThatOnTheClosedCurve) {
  const double tori[][3] = {{2.5, 0.7, 0.266072}, {1.766, 0.459, 0.416469}, {3.738, 0.799, 0.467548}};
  for (const auto& [eta, gamma, turns] : tori) {
    int seen = 0;
    for (const Basin& basin : basins_of({eta, gamma, 0.05}, 20, 10.0)) {
      const Attractor& a = basin.first.attractor;
      if (a.kind != AttractorKind::quasi_periodic) continue;
      EXPECT_NEAR(a.rotation_number, turns, 2e-6) << eta;
      ++seen;
    }
    EXPECT_GT(seen, 0) << eta;
  }
}

// Six small ones, about the points of an orbit of six impacts: a sixth of a turn is not the rotation on them.
TEST(Attractor, CurvesThatAreVisitedInTurnHaveNoRotationNumber) {
  const std::vector<Basin> basins = find_basins({4.717, 0.483, 0.05}, {});
  ASSERT_EQ(basins[0].first.attractor.kind, AttractorKind::quasi_periodic);
  EXPECT_TRUE(std::isnan(basins[0].first.attractor.rotation_number));
}

// The product of 74 Jacobians has lost the least: it gave -1.265.
TEST(Attractor, OfALongPeriodTheExponentsSumUpToTheVolumeToo) {
  int seen = 0;
  for (const Basin& basin : basins_of({2.1139, 0.548, 0.05}, 6, 10.0)) {
    const Attractor& a = basin.first.attractor;
    if (a.name() != "period-74") continue;
    const auto& x = a.lyapunov.exponents;
    EXPECT_NEAR(x[0] + x[1] + x[2] + x[3], a.lyapunov.volume_rate, 1e-3);
    ++seen;
  }
  EXPECT_EQ(seen, 1);
}

// It counted from the end of the transient on, so one orbit was "contact" or not by chance.
TEST(Attractor, TheContactShareOfAPeriodIsThatOfTheOrbit) {
  const Attractor first = from_above(0.3, 0.05);
  ASSERT_EQ(first.kind, AttractorKind::periodic);
  for (const double later : {3.0, 7.0, 11.0}) {
    AttractorSettings settings;
    settings.transient += later;
    const Attractor a = from_above(0.3, 0.05, settings);
    EXPECT_NEAR(a.contact_share, first.contact_share, 1e-6);
    EXPECT_NEAR(a.lyapunov.exponents[1], first.lyapunov.exponents[1], 1e-3);
  }
}

// It was that of the search before, so this orbit was two attractors, of which one was contact.
TEST(Attractor, OfAPeriodThatIsFoundLateTheContactShareIsThatOfTheOrbitToo) {
  SweepPoint point{1.002, 0.7, 0.05};
  point.H = 0.0677;
  const std::vector<Basin> basins = basins_of(point, 2, 50.0);
  ASSERT_EQ(basins.size(), 1u);
  EXPECT_EQ(basins[0].first.attractor.name(), "period-2");
  EXPECT_NEAR(basins[0].first.attractor.contact_share, 0.4623, 1e-3);  // as after a transient of 20000 tau
}

TEST(Attractor, ChaosHasAPositiveExponent) {
  for (const double eta : {0.5, 2.75, 3.4, 5.0, 7.0}) {
    const Attractor a = from_above(eta, 0.1 * eta);
    EXPECT_EQ(a.kind, AttractorKind::chaotic) << eta;
    EXPECT_GT(a.lyapunov.exponents[0], 0.1) << eta;
    EXPECT_EQ(a.cells, 0);
  }
}

TEST(Attractor, DraggedBackwardsTheTipBouncesAsOften) {
  const double forwards = from_above(3.4, 0.34).cells_per_impact, backwards = from_above(-3.4, 0.34).cells_per_impact;
  EXPECT_GT(forwards, 0.5);
  EXPECT_NEAR(backwards, forwards, 0.02);
}

// At eta = 2.5 a torus and an orbit of eight impacts draw different starts.
TEST(Attractor, ATorusBesideAPeriodicOrbit) {
  const std::vector<Basin> basins = basins_of({2.5, 0.7, 0.25}, 100, 200.0);
  const Basin *torus = nullptr, *eight = nullptr;
  double total = 0.0;
  for (const Basin& basin : basins) {
    total += basin.share;
    if (basin.first.attractor.name() == "quasi-periodic" && torus == nullptr) torus = &basin;  // the larger of two
    if (basin.first.attractor.name() == "period-8") eight = &basin;
  }
  EXPECT_NEAR(total, 1.0, 1e-12);
  ASSERT_NE(torus, nullptr);
  ASSERT_NE(eight, nullptr);
  EXPECT_NEAR(torus->first.attractor.lyapunov.exponents[0], 0.0, 0.01);
  EXPECT_GT(torus->first.attractor.rotation_number, 0.0);
  EXPECT_NEAR(eight->share_std_error, std::sqrt(eight->share * (1.0 - eight->share) / 100.0), 1e-12);
}

// At eta = 1 the tip bounces ever lower, towards a glide on which nothing presses it and nothing lifts it.
TEST(Attractor, AtEtaOneTheTipCreepsIntoContact) {
  const Attractor a = from_above(1.0, 0.1);
  EXPECT_EQ(a.name(), "contact");
  EXPECT_GT(a.contact_share, 0.9);
}

TEST(Attractor, WithoutDragThereIsRest) {
  const Attractor rest = from_above(0.0, 0.05);
  EXPECT_EQ(rest.name(), "rest");
  EXPECT_TRUE(std::isnan(rest.lyapunov.exponents[0]) && std::isnan(rest.contact_share));  // they are not measured
}

// Without losses it bounces for ever.
TEST(Attractor, WithoutDragAndLossesThereIsNoRest) {
  const Attractor bouncing = find_attractor(model_with(1.0, 0.05), 0.0, {0.5, 0.0, 0.0, 0.1, 1.0});
  EXPECT_EQ(bouncing.name(), "undecided");
}

// Its exponent of 500 tau may be within four standard errors of zero: it was a torus then.
TEST(Attractor, ChaosIsNoTorus) {
  for (const Basin& basin : basins_of({3.75, 0.7, 0.375}, 100, 200.0)) {
    const Attractor& a = basin.first.attractor;
    EXPECT_TRUE(a.kind != AttractorKind::quasi_periodic || std::abs(a.lyapunov.exponents[0]) <= 0.01);
  }
  AttractorSettings brief;
  brief.duration = 5.0;
  EXPECT_EQ(from_above(3.4, 0.34, brief).kind, AttractorKind::chaotic) << "measured again over longer times";
}

// A bounce without speed comes back within no cell: it was a period, and one attractor stood in the list twice.
TEST(Attractor, TheHammersContactIsOne) {
  int contacts = 0;
  for (const Basin& basin : basins_of({3.0, 0.7, 0.05, ModelKind::hammer}, 100, 200.0)) {
    const Attractor& a = basin.first.attractor;
    contacts += a.kind == AttractorKind::contact ? 1 : 0;
    EXPECT_TRUE(a.impacts == 0 || a.cells > 0) << a.name();
  }
  EXPECT_EQ(contacts, 1);
}

// The budget was that of 1000 tau, whatever time was asked for.
TEST(Attractor, ALongTransientIsObeyed) {
  AttractorSettings settings;
  settings.transient = 300000.0;
  settings.duration = 100.0;
  const Model model = model_with_cutoff(0.34);
  Tip tip(model, 3.4, to_tip_state(model.H, start_at(3.4)));
  EXPECT_EQ(find_attractor(model, tip, settings).name(), "chaotic");
  EXPECT_GT(tip.now().tau, 300000);
}

TEST(Attractor, WithTooSmallABudgetIsUndecided) {
  AttractorSettings settings;
  settings.most_events = 100;
  EXPECT_EQ(find_attractor(model_with_cutoff(0.34), 3.4, {0.5, 0.0, 3.4, 0.1, 1.0}, settings).name(), "undecided");
}

// Near a bifurcation the tip comes to its orbit too slowly to be seen coming back: Newton's method tells where it goes.
TEST(Attractor, SlowlyAttractingOrbitsAreFound) {
  const Model model = model_with_cutoff(0.05);
  AttractorSettings settings;
  settings.transient = 200.0;
  settings.duration = 100.0;
  const Attractor a = find_attractor(model, 2.04, {0.75, 0.0, 1.5, 0.0, 6.0}, settings);  // a torus is born at 2.0426
  EXPECT_EQ(a.name(), "period-1");
  EXPECT_LT(a.lyapunov.exponents[0], 0.0);
  EXPECT_GT(a.lyapunov.exponents[0], -0.05);
}

TEST(Basins, OrbitsThatPassOtherNumbersOfCellsAreTwo) {
  Visit one;
  one.attractor.kind = AttractorKind::periodic;
  one.attractor.impacts = one.attractor.cells = 1;
  Visit two = one;
  EXPECT_TRUE(same_attractor(one, two));
  two.attractor.cells = 2;
  EXPECT_FALSE(same_attractor(one, two));
}

// A map of the basins: each start is in one basin, and leads there by itself too.
TEST(Basins, HoldEachStartOnce) {
  const SweepPoint point{3.75, 0.7, 0.375};
  BasinSettings settings;
  settings.friction_duration = 100.0;
  for (std::uint64_t i = 0; i < 20; ++i) settings.given.push_back(to_free_state(point.H, random_start(point, 1, i)));
  std::vector<int> seen(settings.given.size(), 0);
  const std::vector<Basin> basins = find_basins(point, settings);
  for (const Basin& basin : basins) {
    for (const int start : basin.starts) {
      ++seen[static_cast<std::size_t>(start)];
      EXPECT_TRUE(same_attractor(basin.first, visit(point, static_cast<std::uint64_t>(start), settings)));
    }
  }
  EXPECT_EQ(seen, std::vector<int>(settings.given.size(), 1));
  EXPECT_GE(basins.size(), 2u);  // friction depends on history
}

}  // namespace
}  // namespace afm
