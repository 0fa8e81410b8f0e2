// The audit of friction follows commands, also those that come in the middle of a chatter sequence.
#include "tools/audit/friction_audit.h"

#include <gtest/gtest.h>

#include "node/parameters/parameters.h"
#include "node/wire/message_conversion.h"
#include "trials/random_launches.h"

namespace afm::audit {
namespace {

constexpr double kEta = 0.35;

EmulatorSettings chattering() {
  EmulatorSettings settings;
  settings.model.v_c = 0.005;
  settings.eta = settings.initial.u = kEta;
  settings.samples_per_batch = 10;
  return settings;
}

class Audited {
 public:
  explicit Audited(const EmulatorSettings& settings = chattering())
      : emulator_(settings), units_(node::Parameters().si), audit_(configuration()) {}

  void run_batch() {
    emulator_.run_batch(batch_);
    audit_.add(node::to_impacts(batch_, units_, {}));
    audit_.judge(estimate());
  }
  void change(const LiveSettings& live) {
    emulator_.change(live);
    audit_.change(emulator_.now());
  }
  void drag(double eta) {
    emulator_.drag(eta);
    velocity_ = eta * units_.velocity();
    audit_.command(emulator_.now(), velocity_);
  }
  afm_emulator::Friction estimate() const { return node::to_friction(batch_, velocity_, units_, {}); }
  FrictionAudit& audit() { return audit_; }
  const Emulator& emulator() const { return emulator_; }
  const Batch& batch() const { return batch_; }

 private:
  static afm_emulator::Configuration configuration() {
    node::Parameters parameters;
    parameters.drag_velocity = kEta * Units(parameters.si).velocity();
    return node::to_configuration(parameters, "", "", {});
  }
  Emulator emulator_;
  Units units_;
  FrictionAudit audit_;
  double velocity_ = kEta * units_.velocity();
  Batch batch_;
};

TEST(FrictionAudit, AcceptsCommandsThatSplitChatter) {
  Audited run;
  RandomLaunches random(5);
  int split = 0;
  for (int commands = 0; commands < 5000; ++commands) {
    run.drag(kEta * random.within(0.99, 1.01));
    for (int i = 0; i < 5; ++i) {
      run.run_batch();
      const auto& impacts = run.batch().impacts;
      if (impacts.empty()) continue;
      const bool burst = impacts.front().kind == ImpactKind::burst;
      split += burst && run.batch().friction.energy_loss < impacts.front().energy_loss;
    }
    ASSERT_EQ(run.audit().report().miscounted, 0u) << commands;
    ASSERT_LT(run.audit().report().energy_error, 1e-11) << commands;
  }
  EXPECT_GT(split, 3);
}

// Changes divide bursts whose loss is the error of the law of chatter, of either sign.
FrictionReport report_of_changes(unsigned seed) {
  constexpr double kEtas[] = {0.0, 1.0, 2.0, -3.0, 3.4, 5.0, 7.5};
  EmulatorSettings settings = chattering();
  settings.model.v_c = 0.05;
  settings.samples_per_batch = 200;
  Audited run(settings);
  RandomLaunches random(seed);
  for (int batches = 0; batches < 300; ++batches) {
    if (random.within(0.0, 1.0) < 0.4) run.drag(kEtas[static_cast<int>(random.within(0.0, 7.0))]);
    LiveSettings live = live_settings(run.emulator().settings());
    live.gamma = random.within(0.1, 0.95);
    live.y0 = random.within(-0.01, 0.005);
    if (random.within(0.0, 1.0) < 0.05) run.change(live);
    run.run_batch();
  }
  return run.audit().report();
}

TEST(FrictionAudit, AcceptsChangesThatSplitWeakChatter) {
  for (unsigned seed = 1; seed <= 200; ++seed) {
    const FrictionReport report = report_of_changes(seed);
    ASSERT_EQ(report.miscounted, 0u) << seed;
    ASSERT_LT(report.energy_error, 1e-11) << seed;
  }
}

TEST(FrictionAudit, SeesAnEstimateThatMissesAnImpact) {
  Audited run;
  run.drag(0.51);
  for (int i = 0; i < 20; ++i) run.run_batch();
  auto estimate = run.estimate();
  estimate.energy_loss *= 1.0 - 1e-6;
  --estimate.impact_count;
  run.audit().judge(estimate);
  EXPECT_EQ(run.audit().report().miscounted, 1u);
  EXPECT_GT(run.audit().report().energy_error, 1e-7);
}

// A burst of which a command divides `lost_before` off [J].
FrictionReport report_of_split_burst(double loss, double lost_before) {
  node::Parameters parameters;
  parameters.drag_velocity = kEta * Units(parameters.si).velocity();
  FrictionAudit audit(node::to_configuration(parameters, "", "", {}));
  audit.change({10, 0.0});
  afm_emulator::ImpactArray batch;
  batch.impacts.resize(1);
  afm_emulator::Impact& burst = batch.impacts.front();
  burst.kind = afm_emulator::Impact::BURST;
  burst.count = 8;
  burst.energy_loss = loss;
  audit.add(batch);
  afm_emulator::Friction estimate;
  estimate.energy_loss = burst.energy_loss - lost_before;
  audit.judge(estimate);
  return audit.report();
}

// As runs had them: the parts gain or lose more than the whole, or the whole is a gain.
TEST(FrictionAudit, AcceptsABurstWhosePartsGainWhatItsBouncesLose) {
  for (const auto& [loss, before] :
       {std::pair(-8.477e-30, 1.543e-29), {-1.898e-30, -1.898e-30}, {2.303e-27, -1.609e-27}}) {
    EXPECT_EQ(report_of_split_burst(loss, before).miscounted, 0u) << loss;
    EXPECT_LT(report_of_split_burst(loss, before).energy_error, 1e-12) << loss;
  }
}

TEST(FrictionAudit, RefusesMoreThanABurstCanHaveLost) {
  EXPECT_EQ(report_of_split_burst(-8.477e-30, 1e-24).miscounted, 1u);
  EXPECT_GT(report_of_split_burst(-8.477e-30, 1e-24).energy_error, 0.5);
}

}  // namespace
}  // namespace afm::audit
