#include "afm/level_table.h"

#include <gtest/gtest.h>

#include <cmath>
#include <sstream>

namespace afm {
namespace {

const char kHead[] =
    "# parameters: gamma 0.7 cutoff 0.05 frequency_ratio 6.25 amplitude 0.1 rest_height 0\n"
    "eta,model,contact_tolerance,k_f_error,deflection_error,cost\n";
// At eta 1 bursts save half; at 2 the hammer saves more, and at 3 nothing of it is known.
const char kRows[] =
    "1,oscillator,0,0,0,2\n1,oscillator,0.001,0.01,0.02,1\n"
    "1,hammer,0.001,0.3,0.4,0.95\n"
    "2,oscillator,0,0,0,3\n2,oscillator,0.001,0.03,0.01,1\n"
    "2,hammer,0.001,0.1,0.2,0.5\n"
    "3,oscillator,0.001,0.02,0.02,1\n";

LevelTable table_of(const std::string& text) {
  std::istringstream in(text);
  return LevelTable(in);
}

Model model_at(double gamma = 0.7) {
  Model model;
  model.H = 0.1;
  model.gamma = gamma;
  return model;
}

const Level kEvery{ModelKind::oscillator, 0.0}, kBursts{ModelKind::oscillator, 1e-3}, kHammer{ModelKind::hammer, 1e-3};
const Level kFull{ModelKind::oscillator, 5e-3};  // a user's own

LevelChoice choose(double eta, double tolerance, ToleranceOf of = ToleranceOf::friction,
                   const Model& model = model_at()) {
  static const LevelTable table = table_of(std::string(kHead) + kRows);
  return table.choose(model, eta, tolerance, of, kFull);
}

TEST(LevelTable, TakesTheCheapestThatTheToleranceAllows) {
  EXPECT_TRUE(choose(1.0, 1e-3).level == kEvery);
  EXPECT_EQ(choose(1.0, 1e-3).expected_error, 0.0);
  EXPECT_TRUE(choose(1.0, 0.05).level == kBursts);
  EXPECT_EQ(choose(1.0, 0.05).expected_error, 0.01);
  EXPECT_TRUE(choose(1.0, 0.01).level == kEvery) << "the error must be below the tolerance";
  EXPECT_TRUE(choose(1.0, 0.5).level == kBursts) << "the hammer saves less than a tenth";
  EXPECT_TRUE(choose(2.0, 0.5).level == kHammer);
  EXPECT_TRUE(choose(-2.0, 0.5).level == kHammer);
}

TEST(LevelTable, EveryBounceIsTakenOnlyWhereNoChatterLevelWillDo) {
  const LevelTable table = table_of(std::string(kHead) +
                                    "1,oscillator,0,0,0,1\n"
                                    "1,oscillator,0.001,0.001,0.001,1.1\n");
  EXPECT_TRUE(table.choose(model_at(), 1.0, 0.01, ToleranceOf::friction, kFull).level == kBursts);
  EXPECT_TRUE(table.choose(model_at(), 1.0, 1e-4, ToleranceOf::friction, kFull).level == kEvery);
}

TEST(LevelTable, ToleranceIsOfFrictionOrOfDeflection) {
  EXPECT_TRUE(choose(2.0, 0.02, ToleranceOf::friction).level == kEvery);
  EXPECT_TRUE(choose(2.0, 0.02, ToleranceOf::deflection).level == kBursts);
  EXPECT_EQ(choose(2.0, 0.02, ToleranceOf::deflection).expected_error, 0.01);
}

TEST(LevelTable, BetweenPointsTheWorstCounts) {
  EXPECT_EQ(choose(1.5, 0.05).expected_error, 0.03);
  EXPECT_TRUE(choose(1.5, 0.02).level == kEvery);
  EXPECT_TRUE(choose(2.5, 0.5).level == kBursts) << "the table has no hammer at eta = 3";
  EXPECT_EQ(choose(2.0 + 1e-7, 0.05).expected_error, 0.03) << "the point itself but for rounding";
  const LevelTable table = table_of(std::string(kHead) +
                                    "1,oscillator,0.001,0.01,0.01,1\n1,hammer,0.001,0.1,0.1,0.5\n"
                                    "2,oscillator,0.001,0.01,0.01,1\n2,hammer,0.001,0.1,0.1,2\n");
  EXPECT_TRUE(table.choose(model_at(), 1.0, 0.5, ToleranceOf::friction, kFull).level == kHammer);
  EXPECT_TRUE(table.choose(model_at(), 1.5, 0.5, ToleranceOf::friction, kFull).level == kBursts);
}

TEST(LevelTable, WhereNothingIsGoodEnoughTheBestIsTaken) {
  const LevelChoice choice = choose(3.0, 1e-4);
  EXPECT_TRUE(choice.level == kBursts);
  EXPECT_EQ(choice.expected_error, 0.02);
}

TEST(LevelTable, OutsideTheFullModelIsTakenAndNothingIsKnown) {
  Model lower = model_at();
  lower.y0 = -0.1;
  for (const LevelChoice& choice :
       {choose(0.5, 0.1), choose(3.5, 0.1), choose(0.0, 0.1), choose(NAN, 0.1),
        choose(2.0, 0.1, ToleranceOf::friction, model_at(0.71)), choose(2.0, 0.1, ToleranceOf::friction, lower)}) {
    EXPECT_TRUE(choice.level == kFull);
    EXPECT_TRUE(std::isnan(choice.expected_error));
  }
}

void expect_refused(const std::string& text, const std::string& why) {
  try {
    table_of(text);
    FAIL() << text;
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find(why), std::string::npos) << error.what();
  }
}

TEST(LevelTable, SaysWhatIsWrongWithAFile) {
  const std::string head = kHead, row = "1,oscillator,0.001,0.01,0.02,1\n";
  expect_refused("", "parameters");
  expect_refused(head.substr(head.find('\n') + 1) + row, "does not say for which parameters");
  expect_refused("# parameters: cutoff 0.05 gamma 0.7 frequency_ratio 6.25 amplitude 0.1 rest_height 0\n" +
                     head.substr(head.find('\n') + 1) + row,
                 "does not say for which parameters");
  expect_refused(head, "no row");
  expect_refused("eta,gamma\n1,2\n", "line 1: the head is not eta,model");
  expect_refused(head + "1,hammer,0.05\n", "line 3: '1,hammer,0.05' is not eta,model");
  expect_refused(head + row + "x" + row, "line 4: 'x1,");
  expect_refused(head + "1,oscillator,0.001,0.01,0.02,1,7\n", "line 3");
  expect_refused(head + "1,pendulum,0.001,0,0,1\n", "model = 'pendulum'");
  expect_refused(head + "1,hammer,0.5,0,0,1\n", "contact_tolerance");
  expect_refused(head + "1,hammer,0.001,-1,0,1\n", "negative");
  expect_refused(head + "1,hammer,0.001,nan,0,1\n", "line 3");
  expect_refused(head + row + row, "twice");
}

TEST(LevelTable, KnowsTheHeadThatItWrites) {
  const LevelTable table = table_of(LevelTable::head(model_at()) + "1,oscillator,0.001,0.01,0.02,1\n");
  EXPECT_EQ(table.choose(model_at(), 1.0, 0.1, ToleranceOf::friction, kFull).expected_error, 0.01);
}

}  // namespace
}  // namespace afm
