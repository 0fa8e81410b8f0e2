// With gamma = 1 and without drag the Boltzmann distribution above the surface is stationary, whatever the rate of
// kicks: moments and quantiles against quadrature, within 4 standard errors.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "afm/surface.h"
#include "afm/tip.h"
#include "core/run/batch_means.h"
#include "support/models.h"
#include "trials/boltzmann.h"

namespace afm {

using namespace detail;

namespace {

constexpr double kHolder = 0.1;  // xc [a]: on a slope of 0.36

Model elastic() { return model_with(1.0, Model().v_c); }

struct Figure {
  std::string name;
  double expected;
  std::function<double(const FreeState&)> of;
};

std::vector<Figure> figures(double theta) {
  const Boltzmann exact(theta, kHolder);
  std::vector<Figure> all{{"X", exact.mean_X(), [](const FreeState& s) { return s.X; }},
                          {"X^2", exact.mean_X2(), [](const FreeState& s) { return s.X * s.X; }},
                          {"Y", exact.mean_Y(), [](const FreeState& s) { return s.y; }},
                          {"Y^2", exact.mean_Y2(), [](const FreeState& s) { return s.y * s.y; }},
                          {"u^2", theta, [](const FreeState& s) { return s.u * s.u; }},
                          {"w^2", theta, [](const FreeState& s) { return s.w * s.w; }},
                          {"u w", 0.0, [](const FreeState& s) { return s.u * s.w; }},
                          {"w^4", 3.0 * theta * theta, [](const FreeState& s) { return s.w * s.w * s.w * s.w; }}};
  for (const double t : {-1.2815515655446004, 0.0, 0.6744897501960817}) {  // quantiles 0.1, 0.5, 0.75
    const double v = t * std::sqrt(theta), below = Boltzmann::tail(-t);
    all.push_back({"P(u)", below, [v](const FreeState& s) { return s.u < v ? 1.0 : 0.0; }});
    all.push_back({"P(w)", below, [v](const FreeState& s) { return s.w < v ? 1.0 : 0.0; }});
  }
  for (const double widths : {0.2, 1.0, 2.0}) {
    const double Y = surface_jet(Model{}.H, kHolder).h + widths * std::sqrt(theta) / kTwoPi;
    all.push_back({"P(Y)", exact.below_Y(Y), [Y](const FreeState& s) { return s.y < Y ? 1.0 : 0.0; }});
  }
  // at 0 a boundary of the panels of the quadrature
  all.push_back({"P(X)", exact.below_X(0.0), [](const FreeState& s) { return s.X < 0.0 ? 1.0 : 0.0; }});
  return all;
}

const FreeState kStart{kHolder, 0.0, 0.2, 0.0, 0.0};

struct Setting {
  double theta, kicks_per_tau;
};

class EquilibriumAt : public testing::TestWithParam<Setting> {};

TEST_P(EquilibriumAt, IsTheBoltzmannDistributionAboveTheSurface) {
  constexpr int kBatches = 400, kSamples = 540;  // of 200 tau; of each
  constexpr double kPause = 200.0 / kSamples;
  const auto [theta, kicks_per_tau] = GetParam();
  Tip tip(elastic(), 0.0, kStart);
  tip.set_bath(bath_of(theta, 5.0, kicks_per_tau));
  const std::vector<Figure> all = figures(theta);
  std::vector<std::vector<double>> sums(all.size(), std::vector<double>(kBatches, 0.0));
  for (int i = 0; i < kBatches * kSamples; ++i) {
    while (tip.advance(ModelTime{100, 0.0} + kPause * i) != Outcome::time_limit) continue;
    const FreeState state = tip.state();
    for (std::size_t k = 0; k < all.size(); ++k) sums[k][static_cast<std::size_t>(i / kSamples)] += all[k].of(state);
  }
  for (std::size_t k = 0; k < all.size(); ++k) {
    double mean = 0.0;
    for (const double sum : sums[k]) mean += sum / (kBatches * kSamples);
    EXPECT_LT(std::abs(mean - all[k].expected), 4.0 * mean_error(sums[k]).std_error / kSamples) << all[k].name;
  }
}

std::vector<Setting> settings() {
  std::vector<Setting> all;
  for (const double theta : {0.05, 0.3, 0.926}) {
    for (const double kicks_per_tau : {0.5, 2.0, 8.0}) all.push_back({theta, kicks_per_tau});
  }
  return all;
}

TEST(Equilibrium, DoesNotDriftInAMillionTau) {
  constexpr int kBlocks = 100, kSamples = 2000, kPause = 5;  // tau
  constexpr double kTheta = 0.926, kQ = 5.0;
  Tip tip(elastic(), 0.0, kStart);
  tip.set_bath(bath_of(kTheta, kQ, 2.0));
  std::vector<double> energies(kBlocks, 0.0);
  for (int i = 0; i < kBlocks * kSamples; ++i) {
    while (tip.advance(ModelTime{100 + std::int64_t{kPause} * i, 0.0}) != Outcome::time_limit) continue;
    const FreeState s = tip.state();
    energies[static_cast<std::size_t>(i / kSamples)] += 0.5 * (s.u * s.u + s.w * s.w) / kSamples;
  }
  double mean = 0.0, slope = 0.0, spread = 0.0, variance = 0.0;
  for (const double energy : energies) mean += energy / kBlocks;
  for (int i = 0; i < kBlocks; ++i) {
    const double age = i - 0.5 * (kBlocks - 1), off = energies[static_cast<std::size_t>(i)] - mean;
    slope += age * off;
    spread += age * age;
    variance += off * off / (kBlocks - 1);
  }
  EXPECT_LT(std::abs(slope / spread), 4.0 * std::sqrt(variance / spread));
  EXPECT_LT(std::abs(mean - kTheta), 4.0 * std::sqrt(variance / kBlocks));
}

INSTANTIATE_TEST_SUITE_P(Temperatures, EquilibriumAt, testing::ValuesIn(settings()));

}  // namespace
}  // namespace afm
