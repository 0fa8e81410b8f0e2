#include "common/command_line.h"

#include <gtest/gtest.h>

#include <stdexcept>

namespace afm {
namespace {

struct Values {
  double eta = 3.4;
  int starts = 7;
  std::uint64_t seed = 1;
  std::string model = "oscillator";
  std::vector<std::string> cutoffs{"0.1"};
  std::vector<double> gammas;
  std::vector<std::string> files;
  bool quick = false;
};

struct Answer {
  int code;
  std::string out, err;
  Values values;
};

Answer run(
    std::vector<std::string> arguments, const std::function<int()>& work = [] { return 0; }) {
  Answer answer;
  Values& v = answer.values;
  CommandLine line("tool", "What it does.");
  line.option("eta", v.eta, "drag velocity");
  line.option("starts", v.starts, "how many", {1, 10});
  line.option("seed", v.seed, "of the starts");
  line.option("model", v.model, "which");
  line.option("cutoff", v.cutoffs, "some");
  line.ranges("gamma", v.gammas, "0.5:0.75:0.25", "some more");
  line.flag("quick", v.quick, "sooner");
  line.arguments("files", v.files, "to read");
  arguments.insert(arguments.begin(), "tool");
  std::vector<char*> argv;
  for (std::string& argument : arguments) argv.push_back(&argument[0]);
  testing::internal::CaptureStdout();
  testing::internal::CaptureStderr();
  answer.code = line.run(static_cast<int>(argv.size()), argv.data(), work);
  answer.out = testing::internal::GetCapturedStdout();
  answer.err = testing::internal::GetCapturedStderr();
  return answer;
}

void expect_refused(const std::vector<std::string>& arguments, const std::string& message) {
  bool worked = false;
  const Answer answer = run(arguments, [&] { return worked = true, 0; });
  EXPECT_EQ(answer.code, 2) << message;
  EXPECT_FALSE(worked) << message;
  EXPECT_EQ(answer.err, "tool: " + message + "\n");
}

TEST(CommandLine, TakesValuesOfEveryKind) {
  const Answer answer = run({"--eta", "-3.25", "--starts=2", "--seed", "18446744073709551615", "--model", "hammer",
                             "--cutoff", "0.1,0.2", "1e-3", "--quick", "--", "a", "b"});
  EXPECT_EQ(answer.code, 0) << answer.err;
  EXPECT_EQ(answer.values.eta, -3.25);
  EXPECT_EQ(answer.values.starts, 2);
  EXPECT_EQ(answer.values.seed, 18446744073709551615u);
  EXPECT_EQ(answer.values.model, "hammer");
  EXPECT_EQ(answer.values.cutoffs, (std::vector<std::string>{"0.1", "0.2", "1e-3"}));
  EXPECT_TRUE(answer.values.quick);
  EXPECT_EQ(answer.values.files, (std::vector<std::string>{"a", "b"}));
}

TEST(CommandLine, KeepsDefaults) {
  const Values values = run({}).values;
  EXPECT_EQ(values.eta, 3.4);
  EXPECT_EQ(values.cutoffs, std::vector<std::string>{"0.1"});
  EXPECT_FALSE(values.quick);
}

TEST(CommandLine, TakesEverySpellingOfAWholeNumber) {
  EXPECT_EQ(run({"--seed", "1e8"}).values.seed, 100000000U);
  EXPECT_EQ(run({"--seed", "18446744073709551615"}).values.seed, 18446744073709551615U);
}

TEST(CommandLine, RefusesWithNameValueAndReason) {
  expect_refused({"--eta", "3.4x"}, "--eta = 3.4x: must be a number");
  expect_refused({"--starts", "2.5"}, "--starts = 2.5: must be a whole number");
  expect_refused({"--starts", "1e-1"}, "--starts = 1e-1: must be a whole number");
  expect_refused({"--starts", "1e300"}, "--starts = 1e300: must be a whole number");
  expect_refused({"--starts", "11"}, "--starts = 11: must be between 1 and 10");
  expect_refused({"--seed", "-1"}, "--seed = -1: must be a whole number, not below 0");
}

TEST(CommandLine, RangesTakeNumbersAndRanges) {
  EXPECT_EQ(run({}).values.gammas, (std::vector<double>{0.5, 0.75}));
  EXPECT_EQ(run({"--gamma", "0.1:0.3:0.1,0.7", "1"}).values.gammas, (std::vector<double>{0.1, 0.2, 0.3, 0.7, 1.0}));
  expect_refused({"--gamma", "1", "--gamma", "2"}, "option '--gamma' cannot be specified more than once (see --help)");
  expect_refused({"--gamma", "0.1", "x"}, "gamma = 0.1,x: 'x' is not a number");
  expect_refused({"--gamma", "1:0:0.1"}, "gamma = 1:0:0.1: TO must not be below FROM");
}

TEST(CommandLine, RefusesWhatItDoesNotKnow) {
  expect_refused({"--et", "3"}, "unrecognised option '--et' (see --help)");
  expect_refused({"--eta"}, "the required argument for option '--eta' is missing (see --help)");
  expect_refused({"--eta", "1", "--eta", "2"}, "option '--eta' cannot be specified more than once (see --help)");
}

TEST(CommandLine, HelpShowsOptionsAndDefaultsAndDoesNoWork) {
  for (const char* help : {"--help", "-h"}) {
    const Answer answer = run({"--eta", "1", help}, [] { return 5; });
    EXPECT_EQ(answer.code, 0);
    for (const char* part : {"Usage: tool [OPTION...] files...", "What it does.", "--eta VALUE", "[default: 3.4]",
                             "to read"}) {
      EXPECT_NE(answer.out.find(part), std::string::npos) << part << " in " << answer.out;
    }
  }
}

TEST(CommandLine, TurnsWhatGoesWrongIntoAnExitCode) {
  EXPECT_EQ(run({}, [] { return 3; }).code, 3);
  EXPECT_EQ(run({}, []() -> int { throw std::invalid_argument("eta = 2: no"); }).code, 2);
  const Answer failed = run({}, []() -> int { throw std::runtime_error("disk full"); });
  EXPECT_EQ(failed.code, 1);
  EXPECT_EQ(failed.err, "tool: disk full\n");
}

TEST(CommandLine, RefusesArgumentsWhereItTakesNone) {
  double eta = 3.4;
  CommandLine line("tool", "");
  line.option("eta", eta, "");
  char name[] = "tool", stray[] = "stray";
  char* argv[] = {name, stray};
  testing::internal::CaptureStderr();
  EXPECT_EQ(line.run(2, argv, [] { return 0; }), 2);
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "tool: stray: belongs to no option\n");
}

}  // namespace
}  // namespace afm
