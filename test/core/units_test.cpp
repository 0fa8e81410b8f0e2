#include "afm/units.h"

#include <gtest/gtest.h>

#include <limits>

#include "support/faults.h"

namespace afm {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

TEST(Units, MicaIsThePapersMica) {
  const SiModel mica;
  ASSERT_TRUE(find_faults(mica).empty());
  const Units units(mica);
  EXPECT_DOUBLE_EQ(units.time(), kTwoPi / 40e3);
  EXPECT_NEAR(units.time(), 0.157e-3, 0.001e-3);     // tau
  EXPECT_NEAR(units.velocity(), 3.31e-6, 0.005e-6);  // a/tau
  EXPECT_EQ(units.length(), 0.52e-9);
}

TEST(Units, DefaultsInSiAreTheDefaultsInNaturalUnits) {
  const SiModel si;
  const Model model = Units(si).to_natural(si), natural;
  EXPECT_DOUBLE_EQ(model.frequency_ratio, natural.frequency_ratio);
  EXPECT_DOUBLE_EQ(model.H, natural.H);
  EXPECT_EQ(model.y0, natural.y0);
  EXPECT_EQ(model.gamma, natural.gamma);
  EXPECT_NEAR(model.v_c, natural.v_c, 0.003 * natural.v_c);  // the paper rounds it to 0.166 um/s
}

TEST(Units, FactorsFitTogether) {
  SiModel si;
  si.omega_v_rad_per_s = 1e4;
  si.lattice_spacing_m = 0.3e-9;
  si.tip_mass_kg = 1e-10;
  const Units units(si);
  EXPECT_DOUBLE_EQ(units.velocity(), 0.3e-9 / (kTwoPi * 1e-4));
  EXPECT_DOUBLE_EQ(units.energy(), 1e-10 * units.velocity() * units.velocity());
  EXPECT_DOUBLE_EQ(units.force() * units.length(), units.energy());
  EXPECT_DOUBLE_EQ(units.friction() * units.velocity(), units.force());
}

TEST(Units, ALeverHasItsSpringsAndItsResonance) {
  const Lever lever{0.2, 13e3, 88.2};
  ASSERT_TRUE(find_faults(lever).empty());
  SiModel si;
  set_lever(lever, si);
  EXPECT_DOUBLE_EQ(spring_constant(si), 0.2);
  EXPECT_DOUBLE_EQ(Units(si).time(), 1.0 / 13e3);
  EXPECT_DOUBLE_EQ(Units(si).to_natural(si).frequency_ratio, 21.0);
  EXPECT_EQ(names(find_faults(Lever{0.2, kNaN, 0.0})),
            (std::multiset<std::string>{"resonance_hz", "lateral_spring_constant_n_per_m"}));
}

TEST(Units, ThereAndBackIsTheSame) {
  SiModel si;
  si.surface_amplitude_m = 0.07e-9;
  si.rest_height_m = -0.02e-9;
  si.cutoff_speed = 0.3e-6;
  const Units units(si);
  const Model model = units.to_natural(si);
  EXPECT_DOUBLE_EQ(model.H * units.length(), si.surface_amplitude_m);
  EXPECT_DOUBLE_EQ(model.y0 * units.length(), si.rest_height_m);
  EXPECT_DOUBLE_EQ(model.v_c * units.velocity(), si.cutoff_speed);
  EXPECT_DOUBLE_EQ(model.frequency_ratio * si.omega_v_rad_per_s, si.omega_h_rad_per_s);
  EXPECT_EQ(model.gamma, si.restitution_gamma);
}

TEST(Units, EveryFaultIsListedAtOnceByItsSiName) {
  SiModel si;
  si.omega_v_rad_per_s = 0.0;
  si.tip_mass_kg = -1.0;
  si.lattice_spacing_m = kNaN;
  si.surface_amplitude_m = kNaN;
  si.restitution_gamma = 2.0;
  si.cutoff_speed = -1.0;
  si.rest_height_m = kNaN;
  const std::multiset<std::string> faulty = names(find_faults(si));
  for (const char* name : {"omega_v_rad_per_s", "tip_mass_kg", "lattice_spacing_m", "surface_amplitude_m",
                           "restitution_gamma", "cutoff_speed", "rest_height_m"}) {
    EXPECT_GE(faulty.count(name), 1u) << name;
  }
  EXPECT_EQ(faulty.count("omega_h_rad_per_s"), 0u);
}

struct Wrong {
  const char* name;
  double SiModel::*member;
  double value;
};

TEST(Units, AFaultNamesTheParameterAndShowsTheValueAsItWasGiven) {
  for (const Wrong& wrong : {Wrong{"rest_height_m", &SiModel::rest_height_m, 0.06e-9},                // above the crest
                             Wrong{"rest_height_m", &SiModel::rest_height_m, -1e300},                 // -infinity a
                             Wrong{"lattice_spacing_m", &SiModel::lattice_spacing_m, 0.52},           // in nm
                             Wrong{"omega_h_rad_per_s", &SiModel::omega_h_rad_per_s, 2e3 * 40e3}}) {  // the ratio
    SiModel si;
    si.*wrong.member = wrong.value;
    const std::vector<ParameterError> faults = find_faults(si);
    ASSERT_EQ(faults.size(), 1u) << wrong.name;
    EXPECT_EQ(faults[0].name, wrong.name);
    EXPECT_EQ(faults[0].value, wrong.value);
  }
}

TEST(Units, ALoadOutOfRangeIsNamedByWhoeverGaveIt) {
  for (const double load : {1.0, -1.0}) {  // 1 N: further down than a holder may be; -1 N: it hovers
    SiModel si;
    const std::vector<ParameterError> faults = set_lever_and_load({}, load, si);
    ASSERT_EQ(faults.size(), 1u);
    EXPECT_EQ(faults[0].name, "load_n");
    EXPECT_EQ(faults[0].value, load);
    EXPECT_TRUE(find_faults(si).empty());  // nothing is set, so there is no second complaint
  }
  SiModel si;
  EXPECT_TRUE(set_lever_and_load({}, 1e-9, si).empty());
  EXPECT_DOUBLE_EQ(spring_constant(si) * si.rest_height_m, -1e-9);
}

TEST(Units, AFaultOfALeversFrequencyNamesTheSpringThatWasGiven) {
  SiModel si;
  const double stiff = 1e11;  // N/m: 2e6 times the vertical frequency
  const std::vector<ParameterError> faults = set_lever_and_load({0.2, 13e3, stiff}, 50e-9, si);
  ASSERT_EQ(faults.size(), 1u);  // and none of the load, which another lever would bear
  EXPECT_EQ(faults[0].name, "lateral_spring_constant_n_per_m");
  EXPECT_EQ(faults[0].value, stiff);
  EXPECT_TRUE(find_faults(si).empty());
}

TEST(Units, AFaultOfABathShowsKelvin) {
  const std::vector<ParameterError> faults = find_faults(SiBath{-1.0, 0.01}, Units(SiModel{}));
  EXPECT_EQ(names(faults), (std::multiset<std::string>{"temperature_k", "quality_factor"}));
  EXPECT_EQ(faults[0].value, -1.0);
  EXPECT_NE(faults[0].reason.find(" K"), std::string::npos);
  EXPECT_TRUE(find_faults(SiBath{300.0, 100.0}, Units(SiModel{})).empty());
  SiModel light;  // 300 K are too hot for it
  light.tip_mass_kg /= 2000.0;
  ASSERT_EQ(find_faults(SiBath{300.0, 100.0}, Units(light)).size(), 1u);
  EXPECT_NE(find_faults(SiBath{300.0, 100.0}, Units(light))[0].reason.find(" K: kT is at most 1000 "),
            std::string::npos);
}

TEST(Units, AScaleMustBeOneOfThisWorld) {
  for (double SiModel::*scale : {&SiModel::omega_v_rad_per_s, &SiModel::tip_mass_kg, &SiModel::lattice_spacing_m}) {
    for (const double value : {1e-41, 1e41, 5e-324, 1.7e308}) {
      SiModel si;
      si.*scale = value;
      ASSERT_FALSE(find_faults(si).empty());
      EXPECT_EQ(find_faults(si).front().value, value);
    }
  }
}

}  // namespace
}  // namespace afm
