#include "run_check.h"

#include <limits>

#include "node/wire/checkpoint_message.h"
#include "node/wire/message_conversion.h"
#include "node/wire/topics.h"

namespace afm::replay {
namespace {

std::string to_text(const ModelTime& time) {
  char text[64];
  std::snprintf(text, sizeof text, "%lld + %.17g tau", static_cast<long long>(time.tau), time.phase);
  return text;
}

// When what differs happened.
ModelTime time_of(const afm_emulator::Deflection& batch, std::size_t index, const Resimulation& simulation) {
  return simulation.sample_time(batch.first_sample + index);
}
ModelTime time_of(const afm_emulator::ImpactArray& batch, std::size_t index, const Resimulation& simulation) {
  return index < batch.impacts.size() ? node::from_message(batch.impacts[index].time) : simulation.now();
}
ModelTime time_of(const afm_emulator::Friction& batch, std::size_t, const Resimulation&) {
  return node::from_message(batch.time);
}

// Of the grid of samples; no digest covers it, but where it is not as configured the recording contradicts itself.
bool follows_from_the_rest(const FieldDifference& difference) {
  const std::string& name = difference.field;
  return name == "deflection.time.tau" || name == "deflection.time.phase" || name == "deflection.sample_period";
}

}  // namespace

RunCheck::RunCheck(const Recording& recording, Progress progress)
    : log_(recording), batches_(recording), recorded_(recording, log_), progress_(std::move(progress)) {}

void RunCheck::run() {
  RecordedBatch batch;
  // after a difference only as far as the next digest, which shows whose it is
  while (!(difference_ && difference_->altered) && batches_.next(batch)) {
    if (epoch_ != batch.epoch) begin_epoch(batch);
    if (!difference_) compare(batch);
    recorded_.follow(
        batch, [&](const auto& recorded, const auto& contradiction) { check_digest(batch, recorded, contradiction); });
    check_checkpoints(batch, std::numeric_limits<std::uint64_t>::max());
    last_batch_ = batch.sequence;
    progress_(static_cast<double>(batches_.read()) / static_cast<double>(batches_.size()), end_);
  }
  finish_epoch();
}

void RunCheck::begin_epoch(const RecordedBatch& batch) {
  const bool first = !epoch_;
  if (!first) {
    follows(*epoch_, batch.epoch, "epoch");
    finish_epoch();
  }
  epoch_ = batch.epoch;
  const bool from_start = !first || (batch.deflection && batch.deflection->first_sample == 0);
  next_sample_ = from_start ? std::optional<std::uint64_t>(0) : std::nullopt;
  last_batch_.reset();
  next_checkpoint_ = 0;
  if (difference_) return;
  simulation_ = std::make_unique<Resimulation>(log_.epoch(batch.epoch));
  begin_ = from_start || !batch.deflection ? ModelTime{} : node::from_message(batch.deflection->time);
  if (!from_start) {
    simulation_->forget(batch.deflection ? batch.deflection->first_sample : 0,
                        batch.impacts ? batch.impacts->first_index : 0);
  }
  ++extent_.epochs;
  check_checkpoints(batch, std::numeric_limits<std::uint64_t>::max());
}

// Those that were reported where the simulation is now, after so many commands. What lies behind it, from before the
// recording began or from inside of what is missing, has its own digest alone to be judged by.
void RunCheck::check_checkpoints(const RecordedBatch& batch, std::uint64_t most_commands) {
  if (difference_) return;
  const auto& checkpoints = log_.epoch(batch.epoch).checkpoints;
  for (; next_checkpoint_ < checkpoints.size() && !difference_; ++next_checkpoint_) {
    const auto& recorded = checkpoints[next_checkpoint_];
    const ModelTime time = node::from_message(recorded.time);
    const bool ahead = simulation_->now() < time || simulation_->impacts() < recorded.impacts;
    if (ahead || most_commands < recorded.digest.commands) return;
    const bool here = time == simulation_->now() && recorded.impacts == simulation_->impacts();
    if (here && recorded.layout == state_layout()) check_checkpoint(batch, recorded);
  }
}

void RunCheck::check_checkpoint(const RecordedBatch& batch, const afm_emulator::Checkpoint& recorded) {
  simulation_->apply_commands(recorded.digest.commands);
  auto simulated = simulation_->checkpoint();
  simulated.digest.estimates = recorded.digest.estimates;  // not repeated before the recording began
  simulated.digest.estimates_digest = recorded.digest.estimates_digest;
  // nor what was never published, as the emulator had to let it go
  if (recorded.digest.samples != recorded.samples || recorded.digest.impacts != recorded.impacts)
    simulated.digest = recorded.digest;
  simulated.state_digest = node::digest_of(simulated);
  if (const auto field = find_difference(recorded, simulated)) differ(batch, *field, simulation_->now());
  ++extent_.checkpoints;
}

// Figures that decide how far to simulate must fit together, or an altered one would keep us busy for ever.
bool RunCheck::is_plausible(const RecordedBatch& batch) {
  if (batch.deflection && next_sample_ && !follows_on(batch)) {
    const FieldDifference field{"deflection.first_sample", std::to_string(batch.deflection->first_sample),
                                std::to_string(*next_sample_), 0};
    differ(batch, field, simulation_->now());
    return false;
  }
  // where the recording begins, or batches are missing, nothing else shows how far the run had come
  const bool jumps = !next_sample_ || missing_before(batch) > 0;
  if (batch.deflection && jumps && !is_at_its_time(batch)) {
    const ModelTime recorded = node::from_message(batch.deflection->time);
    const std::uint64_t sample = batch.deflection->first_sample;
    const std::string due = to_text(simulation_->sample_time(sample)) + " for sample " + std::to_string(sample);
    differ(batch, {"deflection.time", to_text(recorded), due, 0}, recorded);
    difference_->altered = true;
    return false;
  }
  if (!batch.friction || ends_in_time(batch)) return true;
  const ModelTime limit = latest_end(batch);
  const std::string end = to_text(node::from_message(batch.friction->time));
  differ(batch, {"friction.time", end, "not after " + to_text(limit), 0}, limit);
  return false;
}

// Batches that the emulator let go were never given a number: whole ones are missed, and what follows is at its time.
bool RunCheck::follows_on(const RecordedBatch& batch) {
  const std::uint64_t missing = missing_before(batch);
  const std::uint64_t size = simulation_->most_samples_per_batch(), first = batch.deflection->first_sample;
  if (first < *next_sample_) return false;
  if (first - *next_sample_ <= missing * size) return true;
  if (!batch.friction || !is_at_its_time(batch) || !ends_in_time(batch)) return false;
  if (unpublished_.messages == 0) unpublished_.first = "before batch " + std::to_string(batch.sequence);
  unpublished_.messages += 3 * ((first - *next_sample_ + size - 1) / size - missing);
  return true;
}

std::uint64_t RunCheck::missing_before(const RecordedBatch& batch) const {
  return last_batch_ ? batch.sequence - *last_batch_ - 1 : 0;
}

// A batch without samples may be of a grid that has never sampled; then it has its end to be judged by.
bool RunCheck::is_at_its_time(const RecordedBatch& batch) const {
  if (batch.deflection->vertical.empty() && batch.friction) return true;
  return node::from_message(batch.deflection->time) == simulation_->sample_time(batch.deflection->first_sample);
}

// When the next sample is due, whoever reports it.
ModelTime RunCheck::latest_end(const RecordedBatch& batch) const {
  if (batch.deflection) return simulation_->sample_time(end_of(*batch.deflection));
  const auto* next = batches_.next_deflection();
  const ModelTime due = next ? simulation_->sample_time(next->first_sample) : ModelTime{};
  if (next && next->epoch == batch.epoch && node::from_message(next->time) == due) return due;
  if (!next_sample_) return {};
  const std::uint64_t most = (missing_before(batch) + 1) * simulation_->most_samples_per_batch();
  return simulation_->sample_time(*next_sample_ + most);
}

// After its last sample, and no later than the next is due.
bool RunCheck::ends_in_time(const RecordedBatch& batch) const {
  const std::uint64_t samples = batch.deflection ? end_of(*batch.deflection) : 0;
  const ModelTime end = node::from_message(batch.friction->time);
  const bool after_last = samples == 0 || simulation_->sample_time(samples - 1) < end;
  return after_last && end <= latest_end(batch);
}

void RunCheck::run_to_end_of(const RecordedBatch& batch) {
  const auto impacts = batch.impacts ? std::optional<std::uint64_t>(end_of(*batch.impacts)) : std::nullopt;
  const ModelTime samples_end = batch.deflection ? simulation_->sample_time(end_of(*batch.deflection)) : ModelTime{};
  const ModelTime end = batch.friction ? node::from_message(batch.friction->time) : samples_end;
  // a batch whose end is not reported may have ended before the next sample was due
  simulation_->run_to(end, batch.friction ? impacts : std::nullopt);
}

void RunCheck::compare(const RecordedBatch& batch) {
  if (!is_plausible(batch)) return;
  const ModelTime from = simulation_->now();
  run_to_end_of(batch);
  next_sample_ = batch.deflection ? end_of(*batch.deflection) : simulation_->samples();
  extent_.model_seconds += (simulation_->now() - from) * simulation_->time_unit();
  if (batch.deflection) {
    const auto& recorded = *batch.deflection;
    expect_same(batch, recorded, simulation_->deflection(recorded.first_sample, recorded.vertical.size()));
    extent_.samples += recorded.vertical.size();
  }
  if (batch.impacts) {
    const auto& recorded = *batch.impacts;
    // all that happened, if nothing else shows how many there should be
    const std::uint64_t count = batch.friction
                                    ? simulation_->impacts() - std::min(simulation_->impacts(), recorded.first_index)
                                    : recorded.impacts.size();
    expect_same(batch, recorded, simulation_->impacts(recorded.first_index, count));
    // an empty list shows nothing else of where it stands
    if (batch.friction && !difference_ && end_of(recorded) != simulation_->impacts()) {
      const std::string so_far = std::to_string(end_of(recorded)), found = std::to_string(simulation_->impacts());
      differ(batch, {"impacts so far", so_far, found, 0}, simulation_->now());
    }
    extent_.impacts += recorded.impacts.size();
  }
  if (batch.friction) {
    auto simulated = simulation_->friction();
    expect_same(batch, *batch.friction, simulated);
    simulation_->digest().add(simulated);
    ++extent_.estimates;
    end_ = simulation_->now();
  }
  simulation_->forget(batch.deflection ? end_of(*batch.deflection) : 0, batch.impacts ? end_of(*batch.impacts) : 0);
}

template <class Message>
void RunCheck::expect_same(const RecordedBatch& batch, const Message& recorded, const Message& simulated) {
  if (difference_) return;
  const auto field = find_difference(recorded, simulated);
  if (!field) return;
  differ(batch, *field, time_of(recorded, field->index, *simulation_));
  if (follows_from_the_rest(*field)) difference_->altered = true;
}

void RunCheck::differ(const RecordedBatch& batch, const FieldDifference& field, const ModelTime& time) {
  difference_ = Difference{field, batch.epoch, batch.sequence, time, simulation_->last_command(), std::nullopt};
}

void RunCheck::check_digest(const RecordedBatch& batch, const afm_emulator::Digest& recorded,
                            const std::optional<FieldDifference>& contradiction) {
  ++extent_.digests;
  if (difference_) {
    difference_->altered = difference_->altered.value_or(false) || contradiction.has_value();
  } else if (contradiction) {
    differ(batch, *contradiction, node::from_message(recorded.time));
    difference_->altered = true;
  }
  check_checkpoints(batch, recorded.commands);
  if (difference_) return;
  simulation_->apply_commands(recorded.commands);
  auto simulated = simulation_->digest().message();
  simulated.estimates = recorded.estimates;  // not repeated before the recording began
  simulated.estimates_digest = recorded.estimates_digest;
  if (const auto field = find_difference(recorded, simulated)) differ(batch, *field, node::from_message(recorded.time));
}

void RunCheck::finish_epoch() {
  if (!simulation_) return;
  extent_.compared_seconds += (end_ - begin_) * simulation_->time_unit();
  extent_.commands += log_.epoch(*epoch_).commands.size();
  simulation_.reset();
}

}  // namespace afm::replay
