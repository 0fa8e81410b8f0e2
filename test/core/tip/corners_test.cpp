// Every corner of the model: drag at rest, very slow and very fast, restitutions and cutoffs at their ends, centres
// just below the crest and far below the surface.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "trials/tip_watch.h"

namespace afm {
namespace {

struct Corner {
  std::string name;
  Model model;
  double eta;
};

Corner corner(const std::string& name, double eta, double gamma, double v_c, double y0) {
  Corner c{name + " at eta " + std::to_string(eta), Model(), eta};
  c.model.gamma = gamma;
  c.model.v_c = v_c;
  c.model.y0 = y0;
  return c;
}

std::vector<Corner> corners() {
  const double H = Model().H;
  std::vector<Corner> all;
  for (const double size : {0.0, 1e-6, 1e-4, 0.03, 0.2, 1.0, 3.0, 6.25, 20.0, 100.0}) {
    for (const double eta : {size, -size}) {
      all.push_back(corner("mica", eta, 0.7, 0.05, 0.0));
      all.push_back(corner("no bounce", eta, 0.0, 0.05, 0.0));
      all.push_back(corner("elastic", eta, 1.0, 0.05, 0.0));
      all.push_back(corner("nearly elastic", eta, 0.999, 0.05, 0.0));
      all.push_back(corner("elastic, no cutoff", eta, 1.0, 0.0, 0.0));
      all.push_back(corner("soft, low cutoff", eta, 0.3, 1e-3, 0.0));
      all.push_back(corner("no cutoff", eta, 0.7, 0.0, 0.0));
      all.push_back(corner("no bounce, no cutoff", eta, 0.0, 0.0, 0.0));
      all.push_back(corner("high cutoff", eta, 0.7, 100.0, 0.0));
      all.push_back(corner("below the crest", eta, 0.7, 0.05, H * (1.0 - 1e-9)));
      all.push_back(corner("far below", eta, 0.7, 0.05, -10.0));
    }
  }
  return all;
}

TEST(Corners, EachKeepsItsEnergyBalanceAndItsTime) {
  constexpr int kTau = 30;
  constexpr std::uint64_t kMostSegmentsATau = 20000;
  for (const Corner& c : corners()) {
    SCOPED_TRACE(c.name);
    TipWatch watch(c.model, c.eta, FreeState{0.25, 0.003, 0.2, c.eta, 0.0}, kDefaultContactTolerance);
    ASSERT_TRUE(watch.advance({kTau, 0.0})) << watch.violation();
    watch.drag(-2.0);
    ASSERT_TRUE(watch.advance({2 * kTau, 0.0})) << watch.violation();
    EXPECT_LE(watch.count().worst_imbalance, 1e-12);
    EXPECT_LE(watch.count().segments, 2 * kTau * kMostSegmentsATau);
  }
}

TEST(Corners, ATipAtRestStaysAtRestCostsNothingAndWakesUp) {
  Tip tip(Model(), 0.0, TipState{0.0, 0.0, 0.0, 0.0, 0.0});
  long segments = 0;
  while (tip.advance_segment({100000, 0.0}) != Outcome::time_limit) ++segments;
  EXPECT_TRUE(tip.in_contact());
  EXPECT_LE(segments, 100000 / 7);
  const FreeState rest = tip.state();
  EXPECT_EQ(rest.phase, 0.0);
  EXPECT_EQ(rest.X, 0.0);
  EXPECT_EQ(rest.u, 0.0);
  tip.drag(3.0);
  int impacts = 0;
  double lost = 0.0;
  while (tip.advance({100100, 0.0}) != Outcome::time_limit) ++impacts, lost += tip.last_impact().energy_loss;
  EXPECT_GT(impacts, 100);
  EXPECT_GT(lost, 1.0);
}

// Drawn down evenly, each bounce is a part of a turn of the spring: 2 atan(omega v / a) / omega. Bounces slower than a
// hundredth of the tolerance are contact, and their time is not waited for.
TEST(Corners, WithoutACutoffTheBurstEndsAtTheAccumulationPoint) {
  for (const double gamma : {0.1, 0.5, 0.7, 0.9}) {
    Model model;
    model.gamma = gamma;
    model.v_c = 0.0;
    model.y0 = -1.0;
    const double a = kTwoPi * kTwoPi * (model.H - model.y0);
    double v = 0.5, lost = 0.0, end = 0.0;
    Tip tip(model, 0.0, TipState{0.0, 0.0, 0.0, 0.0, v});
    for (; v > 1e-300; v *= gamma) {
      end += 2.0 * std::atan(kTwoPi * v / a) / kTwoPi;
      lost += 0.5 * v * v * (1.0 - gamma * gamma);
    }
    double energy_loss = 0.0;
    while (tip.advance({10, 0.0}) == Outcome::impact) energy_loss += tip.last_impact().energy_loss;
    EXPECT_TRUE(tip.in_contact()) << gamma;
    const double slowest = 1e-2 * kDefaultContactTolerance;
    EXPECT_LE(tip.now() - ModelTime{}, end) << gamma;
    EXPECT_GE(tip.now() - ModelTime{}, end - 2.05 * slowest / (a * (1.0 - gamma))) << gamma;
    // the first two flights are looked at by whole turns: their gap is good to an ulp of the height
    EXPECT_NEAR(energy_loss, lost, 2.0 * detail::epsilon<double>() * a) << gamma;
    EXPECT_EQ(tip.advance({1000, 0.0}), Outcome::time_limit) << gamma;
  }
}

}  // namespace
}  // namespace afm
