// Steps in contact against the equation of motion integrated by Taylor series in quad precision, and against energy.
#include "afm/detail/contact_step.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "support/slides.h"
#include "trials/quad.h"

namespace afm {

using namespace detail;

namespace {

// Levers on mica by their frequency ratio and load: the paper's, a stiff one, one that is laterally soft.
struct Lever {
  double frequency_ratio, y0, eta;
};
Model model_of(const Lever& lever) {
  Model model;
  model.frequency_ratio = lever.frequency_ratio;
  model.y0 = lever.y0;
  return model;
}

// Near the end of a step the tip may have left, but the equation of motion goes on.
SlideState<Quad> exact(const Model& model, double eta, const SlideState<double>& start, double s) {
  const SpringConstants<Quad> springs(model);
  SlideState<Quad> q{start.phase, start.X, start.u};
  for (Quad left = s; left > 0;) {
    const SlideSegment<Quad> part(springs, Quad(eta), q);
    const Quad step = left < part.length() ? left : part.length();
    q = part.at(step), left -= step;
  }
  return q;
}

// A pressed tip that swings with an amplitude of up to 0.05 a about its equilibrium.
SlideState<double> pressed_start(const Lever& lever, RandomLaunches& random) {
  const Model model = model_of(lever);
  const double rate = kTwoPi * lever.frequency_ratio;
  for (;;) {
    const SlideState<double> q{random.within(0.0, 1.0), random.within(-0.05, 0.05),
                               lever.eta + rate * random.within(-0.05, 0.05)};
    if (pressure_of(model, q) > 0.5) return q;
  }
}

double error_of(const SlideState<double>& q, const SlideState<Quad>& truth, double rate) {
  const auto off = [](double a, const Quad& b) { return std::abs(static_cast<double>(Quad(a) - b)); };
  return std::max(off(q.X, truth.X), off(q.u, truth.u) / rate);
}

class ContactStepOf : public testing::TestWithParam<Lever> {};

// The error is estimated, so one step in twenty may exceed ten times the tolerance.
TEST_P(ContactStepOf, MeetsItsToleranceAtItsEndAndTenfoldWithin) {
  const Model model = model_of(GetParam());
  for (const double tolerance : {1e-5, 1e-6, 1e-9}) {
    RandomLaunches random(1);
    int missed = 0;
    constexpr int kSteps = 20;
    for (int i = 0; i < kSteps; ++i) {
      const SlideState<double> start = pressed_start(GetParam(), random);
      const ContactStep step(SpringConstants<double>(model), GetParam().eta, start, tolerance, {});
      ASSERT_TRUE(step.is_accurate());
      const double rate = kTwoPi / step.length();  // at most that of the swing
      const double end = error_of(step.at(step.length()), exact(model, GetParam().eta, start, step.length()), rate);
      const double middle = 0.37 * step.length();
      const double within = error_of(step.at(middle), exact(model, GetParam().eta, start, middle), rate);
      ASSERT_LE(end, 100.0 * tolerance);
      ASSERT_LE(within, 1000.0 * tolerance);
      missed += end > 10.0 * tolerance || within > 100.0 * tolerance ? 1 : 0;
    }
    EXPECT_LE(missed, 1) << tolerance;
  }
}

// The swing nearly rests where this step ends: its energy is as small as the error. Once the error stayed.
TEST(ContactStepAt, TheEndOfASwingBalancesItsEnergyToo) {
  constexpr double kEta = 0.3;
  const SpringConstants<double> m(model_of({6.25, -3.0, kEta}));
  const SlideState<double> start{0.89353030665614719, -0.039064087653800462, 0.41453471013762361};
  const ContactStep step(m, kEta, start, 2e-7, {1, 1081.9196393658544});
  const double s = step.length(), work = -m.omega_h * m.omega_h * kEta * step.point(s).extension_integral;
  EXPECT_NEAR(energy_of(m, step.at(s)) - work, energy_of(m, start), 1e-13 * energy_of(m, start));
}

// A tip at rest whose holder begins to move comes to rest again after a swing. Neither its velocity nor its place can
// take an error of energy there.
TEST(ContactStepAt, ACuspBalancesItsEnergyToo) {
  constexpr double kEta = -0.55392796115547704;
  Model model;
  model.H = 0.094768114406325293, model.y0 = -1.6555162499288678, model.frequency_ratio = 37.1742936899699;
  const SpringConstants<double> m(model);
  const SlideState<double> start{0.50122482544297264, 2.5963106884377033e-06, 0.00041762567616257951};
  const ContactStep step(m, kEta, start, 2e-7, {0, 54785.637978331688});
  for (int i = 900; i <= 1000; ++i) {
    const double s = step.length() * i / 1000, work = -m.omega_h * m.omega_h * kEta * step.point(s).extension_integral;
    ASSERT_NEAR(energy_of(m, step.at(s)) - work, energy_of(m, start), 1e-13 * energy_of(m, start)) << i;
  }
  // the work is that of steps of the least tolerance
  double integral = 0.0;
  SlideState<double> q = start;
  for (double left = step.length(); left > 0.0;) {
    const ContactStep finer(m, kEta, q, kFinestStep, {});
    const double s = std::min(left, finer.length());
    integral += finer.point(s).extension_integral, q = finer.at(s), left -= s;
  }
  EXPECT_NEAR(step.point(step.length()).extension_integral, integral, 2e-11 * step.length());
}

// Such a rest, at zero extension, once left an error of up to 1e-5 of the energy at tolerances above 2e-7.
TEST(ContactStepAt, RestUnderAMovingHolderBalancesItsEnergyAtAnyTolerance) {
  RandomLaunches random(7);
  const auto power = [&](double low, double high) { return std::pow(10.0, random.within(low, high)); };
  for (int i = 0; i < 4000; ++i) {
    Model model;
    model.H = random.within(0.02, 0.2), model.y0 = -power(-2.0, 2.0), model.frequency_ratio = power(0.5, 3.0);
    const SpringConstants<double> m(model);
    const double eta = power(-2.0, 3.0), tolerance = power(-9.0, -5.7);
    // from rest, backwards
    const double time = random.within(0.05, 0.95) / model.frequency_ratio;
    SlideState<double> q{random.within(0.0, 1.0), 0.0, 0.0};
    for (double left = time; left > 0.0;) {
      const ContactStep back(m, -eta, q, kFinestStep, {});
      const double s = std::min(left, back.length());
      q = back.at(s), left -= s;
    }
    q.u = -q.u;
    const ContactStep step(m, eta, q, tolerance, {});
    const double rest = std::min(time, step.length());
    for (int k = -10; k <= 10; ++k) {
      const double s = std::min(step.length(), rest * (1.0 + k / 1000.0));
      const double work = -m.omega_h * m.omega_h * eta * step.point(s).extension_integral;
      ASSERT_NEAR(energy_of(m, step.at(s)) - work, energy_of(m, q), 2e-13 * std::max(energy_of(m, q), std::abs(work)))
          << i << " at " << s / step.length();
    }
  }
}

TEST_P(ContactStepOf, BalancesItsEnergyToRoundingEverywhere) {
  const SpringConstants<double> m(model_of(GetParam()));
  const double eta = GetParam().eta;
  RandomLaunches random(2);
  for (int i = 0; i < 200; ++i) {
    const SlideState<double> start = pressed_start(GetParam(), random);
    const ContactStep step(m, eta, start, 1e-6, {});
    const double s = i % 4 == 0 ? step.length() : random.within(0.0, 1.0) * step.length();
    const double before = energy_of(m, start), work = -m.omega_h * m.omega_h * eta * step.point(s).extension_integral;
    ASSERT_NEAR(energy_of(m, step.at(s)) - work, before, 1e-13 * std::max(1.0, before)) << i;
  }
}

TEST_P(ContactStepOf, ItsImpulseAndItsFallAreThoseOfTheReaction) {
  const Model model = model_of(GetParam());
  const SpringConstants<double> m(model);
  RandomLaunches random(4);
  constexpr int kParts = 256;
  int falls = 0;
  for (int i = 0; i < 100; ++i) {
    const SlideState<double> start = pressed_start(GetParam(), random);
    const ContactStep step(m, GetParam().eta, start, 1e-6, {});
    const double part = step.length() / kParts, level = random.within(0.8, 1.2) * step.pressure(start);
    const double fall = step.first_below(level);
    double impulse = 0.0, size = 0.0, first = -1.0;
    for (int k = 0; k < kParts; ++k) {
      const double reaction = pressure_of(model, step.at((k + 0.5) * part));
      if (reaction < level && first < 0.0) first = (k + 0.5) * part;
      impulse += reaction * part, size += std::abs(reaction) * part;
      if (k == kParts / 3 - 1) {
        ASSERT_NEAR(step.impulse((k + 1) * part), impulse, 2e-3 * size) << i;
      }
    }
    ASSERT_NEAR(step.impulse(step.length()), impulse, 2e-3 * size) << i;
    falls += fall > 0.0 ? 1 : 0;
    // a fall for less than a part may pass between the samples, but none between them is missed
    if (first >= 0.0) {
      ASSERT_GE(fall, 0.0) << i;
      ASSERT_LE(fall, first + step.length() / 64) << i;
    }
    if (fall > 0.0 && first >= 0.0) {
      ASSERT_GE(fall, first - step.length() / 64) << i;
    }
  }
  EXPECT_GT(falls, 5);
}

// A tip whose extension is such that the surface presses by 1e-8 to 30 a/tau^2: it may leave at once.
SlideState<double> barely_pressed_start(const Lever& lever, RandomLaunches& random) {
  const Model model = model_of(lever);
  const double wh = kTwoPi * lever.frequency_ratio;
  for (;;) {
    const double phase = random.within(0.0, 1.0), u = lever.eta * random.within(-1.0, 3.0);
    const double reaction = std::pow(10.0, random.within(-8.0, 1.5));
    const SurfaceJet<double> h = surface_jet(model.H, phase);
    const double push = kTwoPi * kTwoPi * (h.h - model.y0) + h.h2 * u * u;
    const double X = (push - reaction * (1.0 + h.h1 * h.h1)) / (h.h1 * wh * wh);
    if (std::abs(h.h1) > 0.1) return {phase, X, u};
  }
}

// Once one step in 50 of these passed a release: the interpolation of the reaction was below zero at the start.
TEST_P(ContactStepOf, IsReleasedWhereTheReactionFirstVanishesAndNotBefore) {
  const Model model = model_of(GetParam());
  const SpringConstants<double> m(model);
  RandomLaunches random(3);
  int releases = 0;
  for (int i = 0; i < 3000; ++i) {
    const SlideState<double> start =
        i % 10 == 0 ? pressed_start(GetParam(), random) : barely_pressed_start(GetParam(), random);
    const ContactStep step(m, GetParam().eta, start, 1e-6, {});
    const double noise = release_noise(m, start.u, start.X);
    const double release = step.find_release(), end = release < 0.0 ? step.length() : release;
    releases += release < 0.0 ? 0 : 1;
    for (int k = 1; k < 100; ++k) {
      ASSERT_GT(pressure_of(model, step.at(end * k / 100.0)), -1e-6) << i << ": " << k << " of " << release;
    }
    if (release >= 0.0) {
      ASSERT_NEAR(pressure_of(model, step.at(release)), -noise, 0.1 * noise) << i;
    }
  }
  EXPECT_GT(releases, 100);
}

// The same motion within what an interpolation may be off, but a close call does not shorten it.
TEST_P(ContactStepOf, LookingAheadFollowsTheMotionAtLeastAsFar) {
  constexpr double kTolerance = 1e-6;
  const Model model = model_of(GetParam());
  const SpringConstants<double> m(model);
  RandomLaunches random(5);
  int longer = 0;
  for (int i = 0; i < 300; ++i) {
    const SlideState<double> start = barely_pressed_start(GetParam(), random);
    const ContactStep motion(m, GetParam().eta, start, kTolerance, {});
    const ContactStep ahead(m, GetParam().eta, start, kTolerance, {}, ContactStep::Purpose::look_ahead);
    ASSERT_GE(ahead.length(), motion.length()) << i;
    longer += ahead.length() > motion.length() ? 1 : 0;
    ASSERT_NEAR(ahead.at(motion.length()).X, motion.at(motion.length()).X, 50.0 * kTolerance) << i;
  }
  EXPECT_GT(longer, 10);
}

INSTANTIATE_TEST_SUITE_P(Levers, ContactStepOf,
                         testing::Values(Lever{6.25, 0.0, 3.0}, Lever{6.25, -0.5, 0.3}, Lever{21.0, -10.0, 3.0},
                                         Lever{14.0, -90.0, 0.03}, Lever{2.0, -5.0, 1.0}, Lever{6.25, -2.0, 9.0}),
                         [](const auto& lever) { return "Number" + std::to_string(lever.index); });

TEST(ContactStep, OfASmallSwingIsAWholeTurn) {
  const Lever lever{21.0, -10.0, 0.2};
  const SpringConstants<double> m(model_of(lever));
  SlideState<double> q{0.5, 0.0, 0.2};
  ContactStep step(m, lever.eta, q, 1e-6, {});
  for (int i = 0; i < 20; ++i) step = ContactStep(m, lever.eta, step.at(step.length()), 1e-6, step.hint());
  EXPECT_GT(step.length(), 0.9 / lever.frequency_ratio / std::sqrt(1.15));  // the load stiffens it by a seventh
}

// There the velocity is so small that the error of the method is a third of its energy.
TEST(ContactStep, BalancesItsEnergyWhereASwingTurnsBackCloseToACrest) {
  constexpr double kEta = 0.05;
  const SpringConstants<double> m{Model()};
  const SlideState<double> start{0.97439721479529662, -0.00023039710013049094, 0.00035161483916327293};
  const ContactStep step(m, kEta, start, 2e-7, {0, 0.0});
  for (int i = 9000; i <= 10000; ++i) {
    const double s = step.length() * i / 10000, work = -m.omega_h * m.omega_h * kEta * step.point(s).extension_integral;
    ASSERT_NEAR(energy_of(m, step.at(s)) - work, energy_of(m, start), 1e-14) << i;
  }
}

TEST(ContactStep, EndsWhateverTheNumbers) {
  using Limits = std::numeric_limits<double>;
  for (const double odd : {Limits::infinity(), -Limits::infinity(), Limits::quiet_NaN(), 1e300, -1e300}) {
    for (int part = 0; part < 3; ++part) {
      const SlideState<double> start{part == 0 ? odd : 0.3, part == 1 ? odd : 0.0, part == 2 ? odd : 1.0};
      const ContactStep step(SpringConstants<double>(Model()), 1.0, start, 1e-6, {});
      EXPECT_GT(step.length(), 0.0);
      EXPECT_FALSE(step.find_release() > step.length());
    }
  }
}

}  // namespace
}  // namespace afm
