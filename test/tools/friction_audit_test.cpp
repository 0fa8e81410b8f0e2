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
  Audited() : emulator_(chattering()), units_(node::Parameters().si), audit_(configuration()) {}

  void run_batch() {
    emulator_.run_batch(batch_);
    audit_.add(node::to_impacts(batch_, units_, {}));
    audit_.judge(estimate());
  }
  void drag(double eta) {
    emulator_.drag(eta);
    velocity_ = eta * units_.velocity();
    audit_.command(emulator_.now(), velocity_);
  }
  afm_emulator::Friction estimate() const { return node::to_friction(batch_, velocity_, units_, {}); }
  FrictionAudit& audit() { return audit_; }
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

// A weak burst, as a recording had it: its parts gain or lose more than the whole.
FrictionReport report_of_split_burst(double lost_before) {
  node::Parameters parameters;
  parameters.drag_velocity = kEta * Units(parameters.si).velocity();
  FrictionAudit audit(node::to_configuration(parameters, "", "", {}));
  audit.change({10, 0.0});
  afm_emulator::ImpactArray batch;
  batch.impacts.resize(1);
  afm_emulator::Impact& burst = batch.impacts.front();
  burst.kind = afm_emulator::Impact::BURST;
  burst.count = 8;
  burst.normal_speed = 1.3e-9;     // m v^2 / 2 = 3.4e-28 J
  burst.energy_loss = -8.477e-30;  // [J]
  audit.add(batch);
  afm_emulator::Friction estimate;
  estimate.energy_loss = burst.energy_loss - lost_before;
  audit.judge(estimate);
  return audit.report();
}

TEST(FrictionAudit, AcceptsABurstWhosePartsGainWhatItsBouncesLose) {
  EXPECT_EQ(report_of_split_burst(1.543e-29).miscounted, 0u);
  EXPECT_LT(report_of_split_burst(1.543e-29).energy_error, 1e-12);
}

TEST(FrictionAudit, RefusesMoreThanABurstCanHaveLost) {
  EXPECT_EQ(report_of_split_burst(1e-27).miscounted, 1u);
  EXPECT_GT(report_of_split_burst(1e-27).energy_error, 0.5);
}

}  // namespace
}  // namespace afm::audit
