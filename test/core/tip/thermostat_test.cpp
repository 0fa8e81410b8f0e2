// The kicks of the bath: their random numbers, their times, and what they do to a spring that touches nothing.
#include "afm/thermostat.h"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <cstring>
#include <limits>
#include <set>
#include <vector>

#include "afm/flight.h"
#include "core/tip/normal_pair.h"
#include "core/tip/philox.h"
#include "support/faults.h"
#include "support/models.h"

namespace afm {

using namespace detail;

namespace {

TEST(Philox, GivesTheKnownAnswersOfItsAuthors) {
  EXPECT_EQ(philox4x32({0, 0, 0, 0}, {0, 0}), (PhiloxCounter{0x6627e8d5, 0xe169c58d, 0xbc57ac4c, 0x9b00dbd8}));
  constexpr std::uint32_t kOnes = 0xffffffff;
  EXPECT_EQ(philox4x32({kOnes, kOnes, kOnes, kOnes}, {kOnes, kOnes}),
            (PhiloxCounter{0x408f276d, 0x41c83b0e, 0xa20bc7c6, 0x6d5451fd}));
  EXPECT_EQ(philox4x32({0x243f6a88, 0x85a308d3, 0x13198a2e, 0x03707344}, {0xa4093822, 0x299f31d0}),  // digits of pi
            (PhiloxCounter{0xd16cfe09, 0x94fdcceb, 0x5001e420, 0x24126ea1}));
}

TEST(NormalPair, IsAFunctionOfSeedStreamAndIndexAndOfNothingElse) {
  std::set<double> seen;
  for (const std::uint64_t seed : {1ull, 2ull, 1ull << 40}) {
    for (const std::uint64_t stream : {0ull, 1ull, 1ull << 40}) {
      for (const std::uint64_t index : {0ull, 1ull, 1ull << 40}) {
        const NormalPair a = normal_pair(seed, stream, index), b = normal_pair(seed, stream, index);
        EXPECT_EQ(std::memcmp(&a, &b, sizeof a), 0);
        seen.insert({a.first, a.second});
      }
    }
  }
  EXPECT_EQ(seen.size(), 2u * 27u);
}

TEST(Thermostat, WithoutABathNeverKicks) {
  Thermostat thermostat;
  EXPECT_EQ(thermostat.next(), kEndOfTime);
  thermostat.set(bath_of(1.0, 0.0, 2.0), 6.25, {3, 0.5});
  EXPECT_EQ(thermostat.next(), kEndOfTime);
}

TEST(Thermostat, KicksAtWholePeriodsWhateverTheTemperatureBecomes) {
  Thermostat thermostat;
  thermostat.set(bath_of(1.0, 100.0, 8.0), 6.25, {3, 0.5});
  EXPECT_EQ(thermostat.next(), (ModelTime{3, 0.625}));
  thermostat.draw();
  thermostat.set(bath_of(0.5, 20.0, 8.0), 6.25, {3, 0.7});
  EXPECT_EQ(thermostat.next(), (ModelTime{3, 0.75}));
  thermostat.set(bath_of(0.5, 20.0, 2.0), 6.25, {3, 0.7});
  EXPECT_EQ(thermostat.next(), (ModelTime{4, 0.7 - 0.5}));
  thermostat.set(bath_of(0.5, 0.0, 2.0), 6.25, {3, 0.9});
  EXPECT_EQ(thermostat.next(), kEndOfTime);
}

TEST(Thermostat, NoRandomNumberIsDrawnTwiceWhenTheRateChanges) {
  Thermostat thermostat;
  std::set<double> noises;
  for (const double rate : {8.0, 2.0, 8.0}) {
    thermostat.set(bath_of(1.0, 100.0, rate), 6.25, {100, 0.0});
    for (int i = 0; i < 10; ++i) noises.insert(thermostat.draw().lateral.noise / std::sqrt(rate));
  }
  EXPECT_EQ(noises.size(), 30u);
}

TEST(Bath, ReportsEveryFaultByName) {
  Bath bath = bath_of(-1.0, 0.01, 1e6);
  bath.lateral_quality_factor = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(names(find_faults(bath)),
            (std::multiset<std::string>{"temperature", "quality_factor", "lateral_quality_factor", "kicks_per_tau"}));
  EXPECT_TRUE(find_faults(Bath{}).empty());
}

// Springs that touch nothing, kicked.
class FreeSprings {
 public:
  FreeSprings(const Bath& bath, const FlightState<double>& start) : springs_(Model{}), state_(start) {
    thermostat_.set(bath, Model{}.frequency_ratio, {});
    period_ = 1.0 / bath.kicks_per_tau;
  }
  void step() {
    const Flight<double> flight(springs_, 0.0, TipState{0.0, state_.X, state_.U, state_.Y - Model{}.H, state_.W});
    state_ = flight.at(period_);
    const Kick kick = thermostat_.draw();
    state_.U += kick.lateral.change(state_.U);
    state_.W += kick.vertical.change(state_.W);
  }
  double Y() const { return state_.Y; }
  double lateral_energy() const { return 0.5 * (state_.U * state_.U + square(springs_.omega_h * state_.X)); }
  double vertical_energy() const { return 0.5 * (state_.W * state_.W + square(springs_.omega_v * state_.Y)); }

 private:
  static double square(double x) { return x * x; }
  SpringConstants<double> springs_;
  FlightState<double> state_;
  Thermostat thermostat_;
  double period_;
};

TEST(FreeSpring, WithoutTemperatureTheEnergyDecaysAsTheQualityFactorSays) {
  Bath bath = bath_of(0.0, 200.0, 7.3);
  bath.lateral_quality_factor = 1000.0;
  FreeSprings springs(bath, {0.0, 0.01, 0.5, 0.3, 1.0});
  const double vertical = springs.vertical_energy(), lateral = springs.lateral_energy();
  constexpr int kSteps = 730;  // 100 tau
  for (int i = 0; i < kSteps; ++i) springs.step();
  const double angle = kTwoPi * kSteps / 7.3;
  EXPECT_NEAR(std::log(vertical / springs.vertical_energy()), angle / 200.0, 0.02);
  EXPECT_NEAR(std::log(lateral / springs.lateral_energy()), angle * Model{}.frequency_ratio / 1000.0, 0.02);
}

// Periodograms of windows of 400 tau, twenty times the memory, against 2 Gamma theta / ((w0^2 - w^2)^2 + (Gamma w)^2).
TEST(FreeSpring, TheSpectrumOfItsNoiseIsALorentzianOfWidthFOverQ) {
  constexpr double kTheta = 0.926, kQ = 20.0, kKicks = 29.0, kStep = 1.0 / kKicks;
  constexpr int kWindows = 500, kSteps = 400 * static_cast<int>(kKicks);
  FreeSprings springs(bath_of(kTheta, kQ, kKicks), {});
  for (int i = 0; i < kSteps; ++i) springs.step();
  std::vector<double> hann(kSteps), power(9, 0.0);
  double weight = 0.0;
  for (int i = 0; i < kSteps; ++i) {
    hann[static_cast<std::size_t>(i)] = 1.0 - std::cos(kTwoPi * (i + 0.5) / kSteps);
    weight += hann[static_cast<std::size_t>(i)] * hann[static_cast<std::size_t>(i)];
  }
  const auto frequency = [](std::size_t k) { return kTwoPi * (1.0 + (static_cast<double>(k) - 4.0) / (2.0 * kQ)); };
  for (int window = 0; window < kWindows; ++window) {
    std::vector<std::complex<double>> sums(power.size()), turns(power.size(), 1.0), turn(power.size());
    for (std::size_t k = 0; k < power.size(); ++k) turn[k] = std::polar(1.0, -frequency(k) * kStep);
    for (const double factor : hann) {
      springs.step();
      for (std::size_t k = 0; k < power.size(); ++k) {
        sums[k] += factor * springs.Y() * turns[k];
        turns[k] *= turn[k];
      }
    }
    for (std::size_t k = 0; k < power.size(); ++k) power[k] += std::norm(sums[k]) * kStep / weight / kWindows;
  }
  const double gamma = kTwoPi / kQ;
  for (std::size_t k = 0; k < power.size(); ++k) {
    const double w = frequency(k), detuning = kTwoPi * kTwoPi - w * w;
    const double expected = 2.0 * gamma * kTheta / (detuning * detuning + gamma * gamma * w * w);
    EXPECT_NEAR(power[k] / expected, 1.0, 4.0 / std::sqrt(kWindows)) << k;  // each is distributed exponentially
  }
}

}  // namespace
}  // namespace afm
