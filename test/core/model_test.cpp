#include "afm/model.h"

#include <gtest/gtest.h>

#include <limits>

#include "support/faults.h"

namespace afm {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

TEST(Model, DefaultsAreThePapersMica) {
  const Model mica;
  EXPECT_TRUE(find_faults(mica).empty());
  EXPECT_EQ(mica.frequency_ratio, 6.25);
  EXPECT_EQ(mica.H, 0.05 / 0.52);
  EXPECT_EQ(mica.y0, 0.0);
  EXPECT_EQ(mica.gamma, 0.7);
}

TEST(Model, NothingIsHiddenByWhatIsNoNumber) {
  for (const double odd : {kNaN, kInfinity, -kInfinity}) {
    const std::multiset<std::string> faulty = names(find_faults(Model{odd, odd, odd, odd, odd}));
    for (const char* name : {"frequency_ratio", "H", "y0", "gamma", "v_c"}) EXPECT_GE(faulty.count(name), 1u) << name;
  }
}

struct Limit {
  const char* name;
  double Model::*member;
  double good, bad;
};

TEST(Model, LimitsAreWhereTheyAreSaidToBe) {
  const double H = Model().H;
  const Limit limits[] = {
      {"frequency_ratio", &Model::frequency_ratio, kMinFrequencyRatio, kMinFrequencyRatio * 0.999},
      {"frequency_ratio", &Model::frequency_ratio, kMaxFrequencyRatio, kMaxFrequencyRatio * 1.001},
      {"H", &Model::H, kMinAmplitude, 0.0},
      {"H", &Model::H, kMinAmplitude, kMinAmplitude * 0.999},
      {"H", &Model::H, kMaxAmplitude, kMaxAmplitude * 1.001},
      {"y0", &Model::y0, H * 0.999, H},
      {"y0", &Model::y0, kMinRestHeight, kMinRestHeight * 1.001},
      {"gamma", &Model::gamma, 0.0, -1e-9},
      {"gamma", &Model::gamma, 1.0, 1.0 + 1e-9},
      {"v_c", &Model::v_c, 0.0, -1e-9},
      {"v_c", &Model::v_c, kMinCutoff, kMinCutoff * 0.999},
  };
  for (const Limit& limit : limits) {
    Model model;
    model.y0 = -1.0;  // below any crest
    model.*limit.member = limit.good;
    EXPECT_TRUE(find_faults(model).empty()) << describe(find_faults(model));
    model.*limit.member = limit.bad;
    EXPECT_EQ(names(find_faults(model)), std::multiset<std::string>{limit.name}) << limit.bad;
  }
}

TEST(Model, AFlatSurfaceIsOneFault) {
  Model flat;
  flat.H = 0.0;  // the holder at mid-surface does not hover over it
  EXPECT_EQ(names(find_faults(flat)), std::multiset<std::string>{"H"});
}

TEST(Model, ADescriptionHasALineForEachFault) {
  EXPECT_EQ(describe({}), "");
  EXPECT_EQ(describe({{"H", -1.0, "too low"}}), "H = -1: too low");
  EXPECT_EQ(describe({{"H", -1.0, "too low"}, {"v_c", 0.5, "odd"}}), "H = -1: too low\nv_c = 0.5: odd");
}

}  // namespace
}  // namespace afm
