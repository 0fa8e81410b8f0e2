#include "resimulation.h"

#include <algorithm>

#include "node/wire/checkpoint_message.h"
#include "node/wire/message_conversion.h"
#include "node/parameters/parameters.h"

namespace afm::replay {
namespace {

template <class T>
std::vector<T> part_of(const std::vector<T>& values, std::uint64_t base, std::uint64_t first, std::uint64_t count) {
  const std::uint64_t size = values.size();
  const std::uint64_t begin = first < base ? 0 : std::min(first - base, size);
  const std::uint64_t end = begin + std::min(count, size - begin);
  return {values.begin() + static_cast<std::ptrdiff_t>(begin), values.begin() + static_cast<std::ptrdiff_t>(end)};
}

template <class T>
void drop_before(std::vector<T>& values, std::uint64_t base, std::uint64_t first) {
  const std::uint64_t dropped = first < base ? 0 : std::min<std::uint64_t>(first - base, values.size());
  values.erase(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(dropped));
}

}  // namespace

Resimulation::Resimulation(const EpochLog& log)
    : log_(log),
      units_(node::si_model(log.configuration)),
      parameters_(log.parameters()),
      emulator_(log.emulator()),
      drags_(log.drags_before()),
      drag_velocity_(log.drag_velocity()),
      first_sample_(emulator_.samples()),
      first_impact_(emulator_.impacts()),
      digest_(log.digest()) {}

std::optional<Applied> Resimulation::last_command() const {
  if (log_.commands.empty()) return {};
  return log_.commands[next_command_ > 0 ? next_command_ - 1 : 0];
}

double Resimulation::batch_length() const {
  return static_cast<double>(settings().samples_per_batch) * settings().sample_period;
}

bool Resimulation::is_due(const Applied& command, const ModelTime& time, std::optional<std::uint64_t> impacts) const {
  const ModelTime begin = time_of(command);
  // at the same time: before an impact that is asked for
  return begin < time || (begin == time && impacts && first_impact_of(command) < *impacts);
}

void Resimulation::run_to(const ModelTime& time, std::optional<std::uint64_t> impacts) {
  while (next_command_ < log_.commands.size() && is_due(log_.commands[next_command_], time, impacts)) {
    const Applied& command = log_.commands[next_command_];
    run_flights(time_of(command), first_impact_of(command));
    apply_next_command();
  }
  run_flights(time, impacts);
}

void Resimulation::apply_commands(std::uint64_t commands) {
  while (next_command_ < log_.commands.size() && log_.commands_before() + next_command_ < commands &&
         time_of(log_.commands[next_command_]) <= now()) {
    apply_next_command();
  }
}

void Resimulation::apply_next_command() {
  std::visit([this](const auto& command) { apply(command); }, log_.commands[next_command_++]);
}

// Into the digest goes what we have computed, not what was reported.

// The error that is expected is the choice's, which is not made again; the energy dropped follows.
template <class Message>
node::AppliedLevel Resimulation::take_level(const Message& applied) {
  const Level level = node::level_of(applied);
  return {level, applied.expected_error, emulator_.set_level(level)};
}

void Resimulation::apply(afm_emulator::AppliedDrag drag) {
  drag_velocity_ = drag.drag_velocity;
  drag.energy_dropped = take_level(drag).energy_dropped * units_.energy();
  emulator_.drag(node::to_eta(drag_velocity_, parameters_.si));
  drag.time = node::to_message(now());
  drag.first_impact = impacts();
  digest_.add(drag);
  ++drags_;
}

void Resimulation::apply(const afm_emulator::AppliedParameters& change) {
  node::set_live(node::to_live(change), parameters_);
  emulator_.change(live_settings(node::emulator_settings(parameters_)));
  const node::AppliedLevel level = take_level(change);
  node::StepperState state;
  state.time = now();
  state.impacts = impacts();
  state.samples = emulator_.samples();
  state.commands = drags_;
  digest_.add(node::to_applied_parameters(state, parameters_, level, {{}, log_.configuration.epoch}));
}

// An impact and the end of a batch may have the same time; then the number shows which is first.
void Resimulation::run_flights(const ModelTime& time, std::optional<std::uint64_t> wanted) {
  const auto lacks_impacts = [&] { return wanted && impacts() < *wanted; };
  while (now() < time || (now() == time && lacks_impacts())) {
    if (lacks_impacts()) {
      emulator_.run_impacts(*wanted - impacts(), batch_);
    } else if (time - now() > batch_length()) {
      emulator_.run_batch(batch_);
    } else {
      emulator_.run_until(time, batch_);
    }
    take(batch_);
  }
}

void Resimulation::take(const Batch& batch) {
  const node::Label label{{}, log_.configuration.epoch};
  const auto deflection = node::to_deflection(batch, 1.0 / parameters_.sample_rate_hz, units_, label);
  const auto impacts = node::to_impacts(batch, units_, label);
  vertical_.insert(vertical_.end(), deflection.vertical.begin(), deflection.vertical.end());
  lateral_.insert(lateral_.end(), deflection.lateral.begin(), deflection.lateral.end());
  impacts_.insert(impacts_.end(), impacts.impacts.begin(), impacts.impacts.end());
  digest_samples(deflection);
  digest_.add(impacts);
  drop_unwanted();
}

// In one go unless a digest begins anew in its midst.
void Resimulation::digest_samples(const afm_emulator::Deflection& batch) {
  const std::uint64_t size = batch.vertical.size();
  const auto add = [&](std::uint64_t begin, std::uint64_t end) {
    afm_emulator::Deflection part;
    part.vertical = part_of(batch.vertical, 0, begin, end - begin);
    part.lateral = part_of(batch.lateral, 0, begin, end - begin);
    digest_.add(part);
  };
  std::uint64_t done = 0;
  for (auto s = log_.stretches.lower_bound(batch.first_sample); s != log_.stretches.end(); ++s) {
    const std::uint64_t begin = *s - batch.first_sample;
    if (begin > size) break;
    add(done, begin);
    digest_.begin_samples(*s);
    done = begin;
  }
  if (done == 0) return digest_.add(batch);
  add(done, size);
}

afm_emulator::Deflection Resimulation::deflection(std::uint64_t first, std::uint64_t count) const {
  afm_emulator::Deflection message;
  message.epoch = log_.configuration.epoch;
  // a batch without samples may lie before a change that then samples faster
  const SampleGrid& grid = emulator_.grid();
  message.time = node::to_message(first < grid.first ? sample_time(first) : grid.time_or_end(first));
  message.first_sample = first;
  message.sample_period = 1.0 / parameters_.sample_rate_hz;
  message.vertical = part_of(vertical_, first_sample_, first, count);
  message.lateral = part_of(lateral_, first_sample_, first, count);
  return message;
}

afm_emulator::ImpactArray Resimulation::impacts(std::uint64_t first, std::uint64_t count) const {
  afm_emulator::ImpactArray message;
  message.epoch = log_.configuration.epoch;
  message.first_index = first;
  message.impacts = part_of(impacts_, first_impact_, first, count);
  return message;
}

afm_emulator::Friction Resimulation::friction() const {
  return node::to_friction(batch_, drag_velocity_, units_, {{}, log_.configuration.epoch});
}

afm_emulator::Checkpoint Resimulation::checkpoint() const {
  // a history without changes of parameters is of a version that had no checkpoints either, or of nobody
  const auto following = [](const auto& messages, std::uint32_t first, std::uint64_t taken) {
    return (messages.empty() ? first : messages.front().header.seq) + static_cast<std::uint32_t>(taken);
  };
  const std::uint64_t drags = drags_ - log_.drags_before();
  const auto* start = log_.start();
  node::CheckpointContext context;
  context.epoch = log_.configuration.epoch;
  context.drags = drags_;
  context.next_drag = following(log_.drags, start ? start->next_drag : 0, drags);
  context.next_parameters = following(log_.changes, start ? start->next_parameters : 0, next_command_ - drags);
  context.drag_velocity = drag_velocity_;
  context.live = node::live_parameters(parameters_);
  SavedState state;
  emulator_.save(state);
  return node::to_checkpoint(context, now(), emulator_.impacts(), emulator_.samples(), digest_, state);
}

void Resimulation::forget(std::uint64_t samples_before, std::uint64_t impacts_before) {
  wanted_sample_ = std::max(wanted_sample_, samples_before);
  wanted_impact_ = std::max(wanted_impact_, impacts_before);
  drop_unwanted();
}

void Resimulation::drop_unwanted() {
  const std::uint64_t sample_end = samples(), impact_end = impacts();
  drop_before(vertical_, first_sample_, wanted_sample_);
  drop_before(lateral_, first_sample_, wanted_sample_);
  drop_before(impacts_, first_impact_, wanted_impact_);
  first_sample_ = sample_end - vertical_.size();
  first_impact_ = impact_end - impacts_.size();
}

}  // namespace afm::replay
