#include "bag_audit.h"

#include <algorithm>
#include <cmath>

#include "node/message_conversion.h"
#include "node/topics.h"

namespace afm::audit {

using replay::end_of;
using replay::RecordedBatch;

BagAudit::BagAudit(const replay::Recording& recording)
    : recording_(recording), log_(recording), batches_(recording), recorded_(recording, log_) {}

std::vector<Finding> BagAudit::run() {
  RecordedBatch batch;
  while (batches_.next(batch)) {
    if (epoch_ != batch.epoch) begin_epoch(batch);
    const bool joined = !history_known_;
    follow_commands(batch);
    if (joined) friction_->gap();  // what was lost before the recording began is not in it
    history_known_ = true;
    check_grid(batch);
    check_impacts(batch);
    add(batch);
    recorded_.follow(batch, [&](const auto&, const auto& contradiction) {
      ++digests_;
      if (contradiction && !contradiction_) contradiction_ = contradiction;
    });
    last_batch_ = batch.sequence;
  }
  finish_epoch();
  check_status();
  std::vector<Finding> findings;
  report_extent(findings);
  report_sequence(findings);
  report_digests(findings);
  report_energy(findings);
  report_friction(findings);
  report_counters(findings);
  return findings;
}

void BagAudit::begin_epoch(const RecordedBatch& batch) {
  if (epoch_) replay::follows(*epoch_, batch.epoch, "epoch");
  finish_epoch();
  const auto& configuration = log_.epoch(batch.epoch).configuration;
  energy_ = std::make_unique<EnergyAudit>(configuration);
  friction_ = std::make_unique<FrictionAudit>(configuration);
  const bool from_start = epoch_ || (batch.deflection && batch.deflection->first_sample == 0);
  if (from_start) next_sample_ = next_impact_ = 0;
  history_known_ = from_start;
  epoch_ = batch.epoch;
  next_command_ = 0;
  last_time_ = {};
  first_time_ = batch.deflection ? node::from_message(batch.deflection->time) : ModelTime{};
  ++epochs_;
}

void BagAudit::finish_epoch() {
  if (!energy_) return;
  const auto& configuration = log_.epoch(*epoch_).configuration;
  energy_->judge(last_time_);
  friction_->finish();
  energy_report_.merge(energy_->report());
  friction_report_.merge(friction_->report());
  model_seconds_ += std::max(0.0, last_time_ - first_time_) * Units(node::si_model(configuration)).time();
}

// Commands that took effect before this batch.
void BagAudit::follow_commands(const RecordedBatch& batch) {
  if (!batch.friction) return;
  const auto& commands = log_.epoch(batch.epoch).commands;
  const ModelTime end = node::from_message(batch.friction->time);
  for (; next_command_ < commands.size(); ++next_command_) {
    const auto& command = commands[next_command_];
    const ModelTime time = node::from_message(command.time);
    const bool at_end = time == end && !(batch.impacts && command.first_impact < end_of(*batch.impacts));
    if (end < time || at_end) return;
    energy_->add_command(time, command.drag_velocity);
    friction_->command(time, command.drag_velocity);
  }
}

// Samples follow without a gap, on their grid of time.
void BagAudit::check_grid(const RecordedBatch& batch) {
  if (!batch.deflection) return;
  const auto& deflection = *batch.deflection;
  const double period = log_.epoch(batch.epoch).configuration.sample_period_tau;
  const bool follows_on = !last_batch_ || batch.sequence == *last_batch_ + 1;
  if (follows_on && next_sample_ && deflection.first_sample != *next_sample_) ++grid_errors_;
  if (!(node::from_message(deflection.time) == multiply(deflection.first_sample, period))) ++grid_errors_;
  if (deflection.vertical.size() != deflection.lateral.size()) ++grid_errors_;
  next_sample_ = end_of(deflection);
  samples_ += deflection.vertical.size();
  if (begin_stamp_.isZero()) begin_stamp_ = deflection.header.stamp;
  end_stamp_ = deflection.header.stamp;
}

// Impacts follow without a gap and in order, within their batch.
void BagAudit::check_impacts(const RecordedBatch& batch) {
  if (!batch.impacts) return;
  const bool follows_on = !last_batch_ || batch.sequence == *last_batch_ + 1;
  if (follows_on && next_impact_ && batch.impacts->first_index != *next_impact_) ++order_errors_;
  next_impact_ = end_of(*batch.impacts);
  ModelTime last = follows_on ? last_time_ : ModelTime{};
  for (const auto& impact : batch.impacts->impacts) {
    const ModelTime time = node::from_message(impact.time);
    if (!(last <= time) || (batch.friction && node::from_message(batch.friction->time) < time)) ++order_errors_;
    last = time;
    ++impacts_;
    bounces_ += impact.count;
    lost_energy_ += impact.energy_loss;
  }
}

void BagAudit::add(const RecordedBatch& batch) {
  if (!batch.is_whole() || (last_batch_ && batch.sequence != *last_batch_ + 1)) {
    energy_->gap();
    friction_->gap();
  }
  if (batch.friction) {
    const ModelTime end = node::from_message(batch.friction->time);
    if (end < last_time_) ++order_errors_;
    last_time_ = end;
  }
  if (!batch.is_whole()) return;
  energy_->add(*batch.deflection);
  energy_->add(*batch.impacts);
  energy_->judge(last_time_);
  friction_->add(*batch.impacts);
  friction_->judge(*batch.friction);
}

void BagAudit::check_status() {
  replay::MessageStream<afm_emulator::EmulatorStatus> statuses(recording_.topic(node::kStatusTopic));
  for (const auto& bag : recording_.bags()) statuses.add(bag->bag, bag->path);
  for (; statuses.head() != nullptr; statuses.pop()) {
    const auto& status = *statuses.head();
    if (status_) status_gaps_ += replay::follows(status_->header.seq, status.header.seq, statuses.topic());
    status_ = status;
  }
}

}  // namespace afm::audit
