// What the node refuses on the parameter server: every fault at once, each with name, value and reason.
#include "node/params/parameters.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include "afm/number_text.h"
#include "node/params/advice.h"

namespace afm::node {
namespace {

using Given = std::map<std::string, XmlRpc::XmlRpcValue>;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN(), kInfinity = std::numeric_limits<double>::infinity();

XmlRpc::XmlRpcValue list(double first, const XmlRpc::XmlRpcValue& second) {
  XmlRpc::XmlRpcValue values;
  values.setSize(2);
  values[0] = first;
  values[1] = second;
  return values;
}

Parameters read(const Given& given, Faults& faults) {
  XmlRpc::XmlRpcValue tree;
  for (const auto& [name, value] : given) tree[name] = value;
  return read_parameters(tree, faults);
}

// The faults as the node reports them, a line each.
std::string refusal(const Given& given) {
  Faults faults;
  read(given, faults);
  return describe(faults);
}

bool is_blamed(const std::string& name, const std::string& faults) {
  return ('\n' + faults).find('\n' + name + " = ") != std::string::npos;
}

TEST(Parameters, EveryFaultIsReportedAtOnce) {
  const Given given{{"restitution_gamma", 1.5},
                    {"tip_mass_kg", -408e-12},
                    {"omega_v_rad_per_s", kNaN},
                    {"time_scale", 0.0},
                    {"batch_rate_hz", "fast"},
                    {"sample_rate_hz", kInfinity},
                    {"gama", 0.7},
                    {"friction_window_tau", -1.0},
                    {"model", "spring"},
                    {"record", "yes please"},
                    {"bag_directory", 5},
                    {"max_drag_velocity", -1.0},
                    {"paused", "no"},
                    {"commands_eta", list(3.4, 99.0)}};
  const std::string faults = refusal(given);
  for (const auto& [name, value] : given) EXPECT_TRUE(is_blamed(name, faults)) << name << " in\n" << faults;
}

// A driver names its nodes below its own name. A group of ours is refused, as it would have no effect.
TEST(Parameters, ANodeBelowMayHaveParametersOfItsOwn) {
  XmlRpc::XmlRpcValue theirs, ours;
  theirs["gain"] = 0.5;
  ours["temperature_k"] = 300.0;
  EXPECT_EQ(refusal({{"controller", theirs}}), "");
  EXPECT_TRUE(is_blamed("bath", refusal({{"bath", ours}})));
  EXPECT_TRUE(is_blamed("temperature_k", refusal({{"temperature_k", theirs}})));
}

TEST(Parameters, ATildeIsTheHomeOfTheUser) {
  Faults faults;
  const std::string home = std::getenv("HOME");
  EXPECT_EQ(read({{"bag_directory", "~"}}, faults).bag_directory, home);
  EXPECT_EQ(read({{"bag_directory", "~/bags"}}, faults).bag_directory, home + "/bags");
  unsetenv("HOME");  // as of a service of the system
  EXPECT_EQ(read({{"bag_directory", "~/bags"}}, faults).bag_directory.front(), '/');
  setenv("HOME", home.c_str(), 1);
  EXPECT_TRUE(faults.empty());
}

TEST(Parameters, AFaultSaysWhatIsWrong) {
  const Given lever_and_mass{{"spring_constant_n_per_m", 0.2},
                             {"resonance_hz", 13e3},
                             {"lateral_spring_constant_n_per_m", 88.2},
                             {"tip_mass_kg", 3e-11}};
  const Given automatic{{"model", "auto"}, {"tolerance", 0.02}, {"level_table", "/no/such/file"}};
  Given other_quantity = automatic;
  other_quantity["tolerance_of"] = "speed";
  const std::vector<std::pair<Given, std::string>> table{
      {{{"tip_mass_kg", "heavy"}}, "tip_mass_kg = \"heavy\": must be a number"},
      {{{"record", 1}}, "record = 1: must be true or false"},
      {{{"drag_speed", 1e-5}}, "drag_speed = 1e-05: there is no such parameter"},
      {{{"time_scale", 200.0}}, "time_scale = 200: must be between 1e-06 and 100"},
      {{{"rest_height_m", 0.06e-9}}, "rest_height_m = 6e-11: "},
      {{{"commands_eta", list(1.0, "fast")}}, "element 1: must be a number"},
      {{{"drag_velocity", -2e-5}, {"max_drag_velocity", 1e-5}}, "drag velocity at start, drag_velocity = -2e-05"},
      {lever_and_mass, "tip_mass_kg = 3e-11: is given beside the spring constants and the resonance"},
      {{{"load_n", 1e-9}, {"rest_height_m", -1e-9}}, "rest_height_m = -1e-09: is given beside load_n"},
      {{{"load_n", -1e-9}}, "rest_height_m = 1.53"},
      {{{"model", "pendulum"}}, "use oscillator, hammer or auto"},
      {{{"model", "auto"}, {"tolerance", 0.02}}, "level_table = \"\": model auto takes its levels from this file"},
      {automatic, "level_table = \"/no/such/file\": cannot be read: No such file"},
      {other_quantity, "tolerance_of = \"speed\": there is no such quantity"}};
  for (const auto& [given, words] : table) EXPECT_NE(refusal(given).find(words), std::string::npos) << refusal(given);
  for (const double tolerance : {0.0, -0.1, kInfinity, kNaN}) {
    Given none = automatic;
    none["tolerance"] = tolerance;
    EXPECT_NE(refusal(none).find("must be above 0 and finite"), std::string::npos) << tolerance;
  }
}

// Its numbers are loaded beside it, over those of the paper's tip.
TEST(Parameters, AFileOfALeverThatSaysNothingOfOneIsRefused) {
  const std::string levers = AFM_CONFIG "/levers/", surfaces = AFM_CONFIG "/surfaces/";
  EXPECT_NE(
      refusal({{"lever_file", surfaces + "nacl.yaml"}}).find("it says nothing of a lever by its lattice_spacing_m"),
      std::string::npos);
  EXPECT_NE(refusal({{"surface_file", levers + "soft.yaml"}}).find("it says nothing of a surface"), std::string::npos);
  EXPECT_EQ(refusal({{"lever_file", levers + "soft.yaml"}, {"surface_file", surfaces + "nacl.yaml"}}), "");
}

TEST(Parameters, WhatCannotBeReadIsBlamedOnce) {
  const std::string faults =
      refusal({{"spring_constant_n_per_m", "2e-1"}, {"resonance_hz", 13e3}, {"lateral_spring_constant_n_per_m", 88.2}});
  EXPECT_EQ(faults.find("spring_constant_n_per_m = \"2e-1\""), 0u) << faults;
  EXPECT_EQ(faults.find('\n'), std::string::npos) << faults;
}

TEST(Parameters, OnlyWhatIsFaultyIsBlamed) {
  for (const double limit : {-1.0, kNaN, 1e-6}) {
    const std::string faults = refusal({{"max_drag_velocity", limit}});
    EXPECT_TRUE(is_blamed("max_drag_velocity", faults)) << limit;
    EXPECT_FALSE(is_blamed("drag_velocity", faults)) << faults;
  }
  const std::string faults = refusal({{"resonance_hz", 13e3}, {"spring_constant_n_per_m", -0.2}});
  EXPECT_TRUE(is_blamed("spring_constant_n_per_m", faults) && is_blamed("lateral_spring_constant_n_per_m", faults));
  EXPECT_FALSE(is_blamed("resonance_hz", faults)) << faults;
  const std::string of_fast_lever = refusal({{"resonance_hz", 75e3},
                                             {"spring_constant_n_per_m", 2.8},
                                             {"lateral_spring_constant_n_per_m", 548.8},
                                             {"max_drag_velocity", 0.01},
                                             {"restitution_gamma", 1.5}});
  EXPECT_FALSE(is_blamed("max_drag_velocity", of_fast_lever)) << of_fast_lever;  // the limit was that of mica's lever
  EXPECT_EQ(refusal({}), "");
  // as a live parameter: the tip began in a valley of its own surface
  Faults none;
  Parameters loaded = read({{"spring_constant_n_per_m", 0.2},
                            {"resonance_hz", 13e3},
                            {"lateral_spring_constant_n_per_m", 88.2},
                            {"surface_amplitude_m", 0.05e-9},
                            {"lattice_spacing_m", 0.399e-9},
                            {"load_n", 0.05e-9}},
                           none);
  EXPECT_TRUE(none.empty() && find_faults(loaded).empty()) << describe(none);
  loaded.si.restitution_gamma = 1.5;
  ASSERT_EQ(find_faults(loaded).size(), 1u) << describe(find_faults(loaded));
}

// Largest distance of the lateral spring from rest in 100 tau [a].
double largest_swing(const Given& given) {
  Faults faults;
  const Parameters parameters = read(given, faults);
  EXPECT_TRUE(faults.empty()) << describe(faults);
  Run run(run_settings(parameters));
  Batch batch = preallocated_batch(parameters);
  double largest = 0.0;
  while (run.now() < ModelTime{100, 0.0}) {
    run.advance(batch);
    for (const double x : batch.lateral) largest = std::max(largest, std::fabs(x));
  }
  return largest;
}

// Dropped, it would keep the energy of its fall in the swing of the lateral spring, as nothing damps it.
TEST(Parameters, ATipUnderALoadBeginsAtRestInAValley) {
  Given lever{{"spring_constant_n_per_m", 0.2}, {"resonance_hz", 13e3}, {"lateral_spring_constant_n_per_m", 88.2}};
  lever["drag_velocity"] = 1e-6;
  Given loaded = lever, pressed = lever;
  loaded["load_n"] = 1e-9;
  pressed["rest_height_m"] = -1e-9 / 0.2;
  Given dropped = loaded;
  dropped["initial_height"] = 0.21;
  EXPECT_LT(largest_swing(loaded), 0.5 * largest_swing(dropped));
  EXPECT_LT(largest_swing(pressed), 0.5 * largest_swing(dropped));
  Faults faults;  // a load that does not hold it down
  EXPECT_EQ(read({{"load_n", 1e-12}}, faults).initial.phase, Parameters().initial.phase);
}

TEST(Parameters, TheLimitOfTheDragGivesWayToASlowLever) {
  const Given slow{{"spring_constant_n_per_m", 0.03},
                   {"resonance_hz", 400.0},
                   {"lateral_spring_constant_n_per_m", 3.0},
                   {"lattice_spacing_m", 0.246e-9},
                   {"drag_velocity", 1e-6}};
  Faults faults;
  for (const double resonance : {400.0, 66.0}) {  // at 66 Hz the product, divided again, is an ulp more
    Given given = slow;
    given["resonance_hz"] = resonance;
    given["drag_velocity"] = read(given, faults).max_drag_velocity;
    const Parameters fastest = read(given, faults);
    EXPECT_EQ(describe(faults), "");
    EXPECT_LE(to_eta(fastest.drag_velocity, fastest.si), kMaxEta);
    EXPECT_NEAR(to_eta(fastest.drag_velocity, fastest.si), kMaxEta, 1e-9);
  }
  Given fast = slow;
  fast["max_drag_velocity"] = 1.1e-4;
  EXPECT_TRUE(is_blamed("max_drag_velocity", refusal(fast)));
  fast = slow;
  fast["drag_velocity"] = 1.1e-4;  // the limit, which nobody gave, was blamed
  EXPECT_TRUE(is_blamed("drag_velocity", refusal(fast)));
  EXPECT_FALSE(is_blamed("max_drag_velocity", refusal(fast)));
}

// The quotient of the limit may be at least 2.2 where the product with the unit of velocity is beyond it.
TEST(Parameters, ACommandOfTheSceneIsJudgedAsItWillBeCommanded) {
  const double unit = Units(SiModel{}).velocity(), eta = 2.2, limit = std::nextafter(eta * unit, 0.0);
  EXPECT_GE(limit / unit, eta);
  Given scene{{"drag_velocity", 0.0}, {"max_drag_velocity", limit}, {"commands_eta", list(eta, -eta)}};
  EXPECT_TRUE(is_blamed("commands_eta", refusal(scene)));
  scene["max_drag_velocity"] = eta * unit;
  EXPECT_EQ(refusal(scene), "");
}

// A lever of omega_h/omega_v = 22 in a bath, with so many kicks.
Parameters heated_lever(double kicks_per_tau, const Given& more = {}) {
  Given given{{"spring_constant_n_per_m", 0.2}, {"resonance_hz", 13e3},    {"lateral_spring_constant_n_per_m", 96.8},
              {"temperature_k", 300.0},         {"quality_factor", 100.0}, {"kicks_per_tau", kicks_per_tau}};
  for (const auto& [name, value] : more) given[name] = value;
  Faults faults;
  const Parameters parameters = read(given, faults);
  EXPECT_TRUE(faults.empty()) << describe(faults);
  return parameters;
}

TEST(Advice, SamplesAtFewPhasesOfTauAreNamed) {
  const auto warnings = [](double resonance_hz, double sample_rate_hz) {
    Faults faults;
    return find_warnings(read({{"omega_v_rad_per_s", kTwoPi * resonance_hz},
                               {"omega_h_rad_per_s", 7.0 * kTwoPi * resonance_hz},
                               {"sample_rate_hz", sample_rate_hz}},
                              faults));
  };
  ASSERT_EQ(warnings(5e6, 2e5).size(), 1u);  // the mean normal force was half as large again
  EXPECT_NE(warnings(5e6, 2e5)[0].find("at 1 of its phases"), std::string::npos);
  EXPECT_NE(warnings(1e5, 2e5)[0].find("at 2 of its phases"), std::string::npos);
  EXPECT_TRUE(warnings(5e6, 1.9e5).empty());
  EXPECT_TRUE(warnings(7.5e4, 2e5).empty());
}

TEST(Advice, HeatWithoutDampingHasNoEffect) {
  Faults faults;
  EXPECT_EQ(find_warnings(read({{"temperature_k", 300.0}}, faults)).size(), 1u);
  EXPECT_TRUE(find_warnings(read({{"temperature_k", 300.0}, {"quality_factor", 100.0}}, faults)).empty());
}

TEST(Advice, InLockstepOnlyAWaitForCommandsHasATimeout) {
  Faults faults;
  const Given lockstep{{"pace", "lockstep"}, {"command_timeout_s", 0.5}};
  EXPECT_EQ(find_warnings(read(lockstep, faults)).size(), 1u);
  Given waiting = lockstep;
  waiting["wait_for"] = "command";
  EXPECT_TRUE(find_warnings(read(waiting, faults)).empty());
}

TEST(Advice, InLockstepABagThatIsSplitEndsTheSameBits) {
  Faults faults;
  EXPECT_EQ(find_warnings(read({{"pace", "lockstep"}, {"split_size_mb", 100.0}}, faults)).size(), 1u);
  EXPECT_TRUE(find_warnings(read({{"split_size_mb", 100.0}}, faults)).empty());
}

TEST(Advice, ARunThatIsTooSlowIsToldHowSlowlyItCanRun) {
  const std::string fault = find_speed_warning(heated_lever(29.034), 0.5);
  EXPECT_NE(fault.find("Give time_scale = 0.3"), std::string::npos) << fault;  // 0.7 of it, one digit
  EXPECT_NE(fault.find("kicks_per_tau = 13.597"), std::string::npos) << fault;
  EXPECT_EQ(find_speed_warning(heated_lever(29.034, {{"time_scale", 0.3}}), 0.5), "");
  EXPECT_EQ(find_speed_warning(heated_lever(29.034, {{"pace", std::string("lockstep")}}), 0.5), "");
}

// The time_scale was that of the rate in force: with the rate that was advised beside it the run fell behind.
TEST(Advice, WhereMoreKicksAreAdvisedTheTimeScaleIsThatOfThem) {
  const Parameters liquid = heated_lever(29.034, {{"quality_factor", 2.0}});
  ASSERT_EQ(find_warnings(liquid).size(), 1u);
  const std::string fault = find_speed_warning(liquid, 0.5);
  const double kicks = suitable_kicks(run_settings(liquid).model, run_settings(liquid).bath);
  EXPECT_GT(kicks, 20.0 * 29.034);
  for (const std::string& warning : {find_warnings(liquid)[0], fault}) {
    EXPECT_NE(warning.find(number_text(kicks)), std::string::npos) << warning;
  }
  EXPECT_NE(fault.find("Give time_scale = 0.01 with kicks_per_tau"), std::string::npos) << fault;
}

TEST(Advice, KicksThatLockToTheDragOfTheStartOrOfTheSceneAreNamedOnce) {
  Faults faults;
  const double locked = 29.034, free = 2.0;  // a/tau, at 29.034 kicks a tau
  const auto warnings = [&](double start, double first, double second) {
    return find_warnings(read({{"quality_factor", 20.0},
                               {"drag_velocity", start * Units(SiModel{}).velocity()},
                               {"commands_eta", list(first, second)}},
                              faults));
  };
  EXPECT_TRUE(warnings(free, free, -free).empty());
  for (const auto& found : {warnings(locked, free, -free), warnings(free, locked, -locked)}) {
    ASSERT_EQ(found.size(), 1u);
    EXPECT_NE(found[0].find("locks to the drag near eta = 29.034,"), std::string::npos) << found[0];
  }
  EXPECT_EQ(describe(faults), "");
}

TEST(Advice, TheTrialOfATipThatSticksAndSlipsHasItsSlips) {
  const auto crosses_a_cell = [](double load_n) {
    Given given{{"spring_constant_n_per_m", 0.5},
                {"resonance_hz", 20e3},
                {"lateral_spring_constant_n_per_m", 2.0},
                {"lattice_spacing_m", 0.246e-9},
                {"drag_velocity", 5e-8}};
    given["load_n"] = load_n;
    Faults faults;
    afm::Run run = trial_run(read(given, faults));
    EXPECT_EQ(describe(faults), "");
    double most = 0.0;
    Batch batch;
    for (int i = 0; i < 100; ++i) {
      run.advance(run.now() + 0.1, 1000000, batch);
      for (const double x : batch.lateral) most = std::max(most, std::abs(x));
    }
    return most > 1.0;
  };
  EXPECT_TRUE(crosses_a_cell(100e-9));
  EXPECT_FALSE(crosses_a_cell(0.1e-9));
}

TEST(Advice, TheTipIsDescribedWithTheBathOfEitherSpring) {
  Faults faults;
  const std::string text = describe_tip(read({{"lateral_quality_factor", 20.0}, {"temperature_k", 300.0}}, faults));
  EXPECT_NE(text.find("; lateral Q = 20 at 300 K, 29.034 kicks a tau"), std::string::npos) << text;
}

}  // namespace
}  // namespace afm::node
