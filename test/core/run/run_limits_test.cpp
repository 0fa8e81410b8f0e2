// What a run does at its limits: a spent budget, a faulty parameter.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "support/commands.h"
#include "support/faults.h"

namespace afm {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

TEST(RunLimits, ASpentBudgetIsCountedAndTimeIsHonest) {
  RunSettings settings = settings_at(3.0, 2000);  // chatters: many impacts a tau
  settings.model.v_c = 0.1;
  settings.impact_budget = 10;
  afm::Run run(settings);
  Batch batch;
  for (std::uint64_t spent = 1; spent <= 20; ++spent) {
    ASSERT_EQ(run.advance(batch), Outcome::budget_spent);
    ASSERT_EQ(run.counters().budget_exhausted, spent);
    ASSERT_LE(batch.impacts.size(), 10u);
    ASSERT_TRUE(batch.end == run.now());
    ASSERT_TRUE(batch.impacts.back().time <= batch.end);
    ASSERT_TRUE(batch.begin < batch.end);
    // every sample before the end is there, and none after it
    const std::uint64_t next = batch.first_sample + batch.vertical.size();
    ASSERT_TRUE(batch.end <= multiply(next, settings.sample_period));
    ASSERT_TRUE(next == 0 || multiply(next - 1, settings.sample_period) < batch.end);
  }
}

// At 1 a/tau the crest just carries a tip: swung over it in its spring a little faster, it presses at both ends of the
// swing and hardly between, and bounces thousands of times a tau for hundreds of tau.
TEST(RunLimits, ATipThatRingsOverACrestStaysWithinTheDefaultBudget) {
  RunSettings settings;
  settings.eta = 0.0;
  settings.sample_period = 0.0318;  // of the node: 10 ms are 64 tau
  const double H = settings.model.H;
  std::vector<FreeState> starts{{0.06, 0.02, H * std::cos(kTwoPi * 0.06) + 1e-3, 0.5, 0.0}};
  for (const double u : {1.0, 1.02, 1.05, 1.1, 1.2}) starts.push_back({0.0, 0.0, H + 1e-5, u, 0.0});
  for (const FreeState& start : starts) {
    settings.initial = start;
    afm::Run run(settings);
    Batch batch;
    for (int i = 0; i < 10; ++i) ASSERT_EQ(run.advance(batch), Outcome::time_limit) << start.phase << ' ' << start.u;
  }
}

TEST(RunLimits, EveryFaultIsListedAtOnce) {
  RunSettings settings;
  settings.model.gamma = 2.0;
  settings.eta = kNaN;
  settings.sample_period = 0.0;
  settings.samples_per_batch = 0;
  settings.friction_window = -1.0;
  settings.impact_budget = 0;
  settings.initial = {kNaN, 11.0, kNaN, 1e4, -1e4};
  EXPECT_EQ(names(find_faults(settings)),
            (std::multiset<std::string>{"gamma", "eta", "sample_period", "samples_per_batch", "friction_window",
                                        "impact_budget", "initial_phase", "initial_extension", "initial_height",
                                        "initial_u", "initial_w"}));
  EXPECT_THROW(afm::Run{settings}, ParameterError);
  settings = {};
  settings.initial = {0.0, 0.0, 0.0, kNaN, 0.0};  // below the crest, which was hidden by the velocity
  EXPECT_EQ(names(find_faults(settings)), (std::multiset<std::string>{"initial_height", "initial_u"}));
  settings.initial = {0.0, 0.0, -1000.0, 0.0, 0.0};  // and is not named twice
  EXPECT_EQ(names(find_faults(settings)), (std::multiset<std::string>{"initial_height"}));
  EXPECT_THROW(afm::Run{settings}, ParameterError);
}

TEST(RunLimits, ABatchThatNoMemoryHoldsIsAFault) {
  RunSettings settings;
  settings.samples_per_batch = settings.impact_budget = 10000001;
  EXPECT_EQ(names(find_faults(settings)), (std::multiset<std::string>{"samples_per_batch", "impact_budget"}));
}

TEST(RunLimits, ATimeOrAnErrorOfNextToNothingIsAFault) {
  RunSettings settings;
  settings.contact_tolerance = kMinContactTolerance;
  settings.sample_period = 1e-9;
  EXPECT_TRUE(find_faults(settings).empty());
  settings.contact_tolerance *= 0.999;
  settings.sample_period *= 0.999;
  EXPECT_EQ(names(find_faults(settings)), (std::multiset<std::string>{"contact_tolerance", "sample_period"}));
}

}  // namespace
}  // namespace afm
