#include "bag_audit.h"

#include <algorithm>
#include <cmath>

#include "node/wire/message_conversion.h"
#include "node/wire/topics.h"

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
    count_impacts(batch);
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
  report_balance(findings);
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
  begin_where_known(log_.epoch(batch.epoch));
  first_time_ = batch.deflection ? node::from_message(batch.deflection->time) : ModelTime{};
  ++epochs_;
}

// At the beginning of the epoch, or at the checkpoint that the recording begins with.
void BagAudit::begin_where_known(const replay::EpochLog& log) {
  const EmulatorSettings& settings = log.emulator().settings();
  parameters_ = log.parameters();
  level_ = {settings.model.kind, settings.contact_tolerance};
  grid_ = log.emulator().grid();
  last_time_ = log.emulator().now();
  kicks_ = log.emulator().thermostat();
  energy_->set_bath(kicks_);
  friction_->set_tolerance(level_.contact_tolerance);
  if (log.start() == nullptr) return;
  energy_->change(settings.model, grid_);
  energy_->add_command(last_time_, log.drag_velocity());
  friction_->command(log.emulator().estimated_since(), log.drag_velocity());
  friction_->change(log.emulator().estimated_since());
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
    const replay::Applied& command = commands[next_command_];
    const ModelTime time = replay::time_of(command);
    const bool at_end = time == end && !(batch.impacts && replay::first_impact_of(command) < end_of(*batch.impacts));
    if (end < time || at_end) return;
    std::visit([this](const auto& applied) { follow(applied); }, command);
  }
}

void BagAudit::follow_level(const Level& level, const ModelTime& time) {
  if (level == level_) return;
  level_ = level;
  energy_->change(at_level(node::emulator_settings(parameters_).model, level), grid_);
  friction_->change(time);
  friction_->set_tolerance(level.contact_tolerance);
}

void BagAudit::follow(const afm_emulator::AppliedDrag& drag) {
  follow_level(node::level_of(drag), node::from_message(drag.time));
  energy_->add_command(node::from_message(drag.time), drag.drag_velocity);
  friction_->command(node::from_message(drag.time), drag.drag_velocity);
}

void BagAudit::follow(const afm_emulator::AppliedParameters& change) {
  const node::LiveParameters before = node::live_parameters(parameters_), after = node::to_live(change);
  const ModelTime time = node::from_message(change.time);
  if (after == before) return follow_level(node::level_of(change), time);
  node::set_live(after, parameters_);
  const EmulatorSettings settings = node::emulator_settings(parameters_);
  while (kicks_.next() <= time) kicks_.draw();
  if (settings.bath != kicks_.bath()) kicks_.set(settings.bath, settings.model.frequency_ratio, time);
  if (after.sample_rate_hz != before.sample_rate_hz) grid_ = {change.sample_period_tau, change.first_sample, time};
  energy_->change(at_level(settings.model, level_), grid_);
  energy_->set_bath(kicks_);
  node::LiveParameters same_model = before;  // but for what the tip knows nothing of
  same_model.sample_rate_hz = after.sample_rate_hz;
  same_model.friction_window_tau = after.friction_window_tau;
  if (!(after == same_model)) friction_->change(time);
  ++changes_;
  follow_level(node::level_of(change), time);
}

// Samples follow without a gap, on their grid of time.
void BagAudit::check_grid(const RecordedBatch& batch) {
  if (!batch.deflection) return;
  const auto& deflection = *batch.deflection;
  const bool follows_on = !last_batch_ || batch.sequence == *last_batch_ + 1;
  if (follows_on && next_sample_ && deflection.first_sample != *next_sample_) ++grid_errors_;
  // without its end it is not known which commands took effect before it
  const ModelTime due = grid_.time_or_end(deflection.first_sample);
  if (batch.friction && !(node::from_message(deflection.time) == due)) ++grid_errors_;
  if (deflection.vertical.size() != deflection.lateral.size()) ++grid_errors_;
  next_sample_ = end_of(deflection);
  samples_ += deflection.vertical.size();
  if (begin_stamp_.isZero()) begin_stamp_ = deflection.header.stamp;
  end_stamp_ = deflection.header.stamp;
}

// It ends after its last sample, and no later than the next is due.
bool BagAudit::has_its_end(const RecordedBatch& batch) const {
  const std::uint64_t samples = end_of(*batch.deflection);
  const ModelTime end = node::from_message(batch.friction->time);
  if (samples < grid_.first || !(last_time_ <= end && end <= grid_.time_or_end(samples))) return false;
  return samples == grid_.first || grid_.time(samples - 1) < end;
}

bool BagAudit::has_ordered_impacts(const RecordedBatch& batch) const {
  ModelTime last = last_time_;
  for (const auto& impact : batch.impacts->impacts) {
    const ModelTime time = node::from_message(impact.time);
    if (!(last <= time) || !(time.phase >= 0.0 && time.phase < 1.0)) return false;
    last = time;
  }
  return last <= node::from_message(batch.friction->time);
}

void BagAudit::count_impacts(const RecordedBatch& batch) {
  if (!batch.impacts) return;
  const bool follows_on = !last_batch_ || batch.sequence == *last_batch_ + 1;
  if (follows_on && next_impact_ && batch.impacts->first_index != *next_impact_) ++order_errors_;
  next_impact_ = end_of(*batch.impacts);
  impacts_ += batch.impacts->impacts.size();
  for (const auto& impact : batch.impacts->impacts) bounces_ += impact.count;
}

// Only what stands at its time goes into the sums; the rest is counted, and what follows begins anew.
void BagAudit::add(const RecordedBatch& batch) {
  const bool follows_on = !last_batch_ || batch.sequence == *last_batch_ + 1;
  const bool in_order = !batch.is_whole() || (has_its_end(batch) && has_ordered_impacts(batch));
  if (!in_order) ++order_errors_;
  if (!in_order || !follows_on || !batch.is_whole()) {
    energy_->gap();
    friction_->gap();
  }
  if (!in_order || !batch.is_whole()) return;
  last_time_ = node::from_message(batch.friction->time);
  energy_->add(*batch.deflection);
  energy_->add(*batch.impacts);
  energy_->add(*batch.friction, friction_->since());
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
