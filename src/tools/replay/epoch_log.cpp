#include "epoch_log.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "message_difference.h"
#include "node/wire/checkpoint_message.h"
#include "verdict.h"

namespace afm::replay {
namespace {

[[noreturn]] void nonsense(std::uint32_t epoch, const std::string& what) {
  throw Problem(Verdict::altered, "epoch " + std::to_string(epoch) + ": " + what);
}

[[noreturn]] void missing(std::uint32_t epoch, const std::string& what) {
  throw Problem(Verdict::missing, "epoch " + std::to_string(epoch) + ": " + what);
}

// What a node would refuse to run, or would have derived in another way, is no configuration that ran.
void check_configuration(const afm_emulator::Configuration& c) {
  const node::Parameters parameters = node::to_parameters(c);
  const node::Faults faults = node::find_faults(parameters);
  if (!faults.empty()) nonsense(c.epoch, "its configuration cannot be run: " + node::describe(faults));
  const node::Label label{c.header.stamp, c.epoch};
  const auto derived = node::to_configuration(parameters, c.version, c.arithmetic_digest, label);
  if (const auto difference = find_difference(c, derived)) {
    nonsense(c.epoch, difference->field + " is " + difference->first + ", and from the rest of the configuration " +
                          difference->second + " follows");
  }
}

// Likewise.
void check_change(const afm_emulator::AppliedParameters& change, node::Parameters parameters) {
  node::set_live(node::to_live(change), parameters);
  const node::Faults faults = node::find_faults(parameters);
  if (!faults.empty()) nonsense(change.epoch, "a change of parameters cannot be: " + node::describe(faults));
  auto derived = node::to_applied_parameters({}, parameters, {}, {change.header.stamp, change.epoch});
  derived.time = change.time;
  derived.first_impact = change.first_impact;
  derived.first_sample = change.first_sample;
  derived.first_command = change.first_command;
  derived.model = change.model;
  derived.contact_tolerance = change.contact_tolerance;
  derived.expected_error = change.expected_error;
  derived.energy_dropped = change.energy_dropped;
  if (const auto difference = find_difference(change, derived)) {
    nonsense(change.epoch, difference->field + " is " + difference->first + ", and from the rest of the parameters " +
                               difference->second + " follows");
  }
}

// A state to begin with; throws Problem where it is none for this program and this epoch.
Emulator restore(const afm_emulator::Checkpoint& checkpoint, const afm_emulator::Configuration& configuration) {
  if (checkpoint.layout != state_layout()) {
    throw Problem(Verdict::foreign, "epoch " + std::to_string(checkpoint.epoch) +
                                        ": begins with a checkpoint of layout " + std::to_string(checkpoint.layout) +
                                        ", and this program reads layout " + std::to_string(state_layout()) +
                                        ": check it with version " + configuration.version +
                                        " of the emulator, which recorded it");
  }
  const auto emulator = node::restored(checkpoint);
  const std::uint64_t recorded = checkpoint.digest.configuration_digest;
  if (!emulator || recorded != node::RunDigest(configuration).message().configuration_digest) {
    nonsense(checkpoint.epoch, "the checkpoint that it begins with is no state of this run");
  }
  return *emulator;
}

// All samples that are due before a change are taken before it, and no others.
bool fits(const afm_emulator::AppliedParameters& change, const SampleGrid& grid) {
  const ModelTime time = node::from_message(change.time);
  const std::uint64_t sample = change.first_sample;
  return sample >= grid.first && time <= grid.time_or_end(sample) &&
         (sample == grid.first || grid.time(sample - 1) < time);
}

}  // namespace

std::string to_text(const Applied& applied) {
  const ModelTime time = time_of(applied);
  char text[512], when[64];
  std::snprintf(when, sizeof when, "%lld + %.17g tau", static_cast<long long>(time.tau), time.phase);
  if (const auto* drag = std::get_if<afm_emulator::AppliedDrag>(&applied)) {
    std::snprintf(text, sizeof text, "%.17g m/s at %s", drag->drag_velocity, when);
  } else {
    const auto& p = std::get<afm_emulator::AppliedParameters>(applied);
    std::snprintf(text, sizeof text,
                  "gamma %g, cutoff %g m/s, rest height %g m, %g samples/s, window %g tau, %g K, quality factors %g "
                  "and %g, %g kicks a tau at %s",
                  p.restitution_gamma, p.cutoff_speed, p.rest_height_m, p.sample_rate_hz, p.friction_window_tau,
                  p.temperature_k, p.quality_factor, p.lateral_quality_factor, p.kicks_per_tau, when);
  }
  return text;
}

std::uint64_t EpochLog::most_samples_per_batch() const {
  std::uint64_t most = configuration.samples_per_batch;
  for (const auto& change : changes) most = std::max(most, change.samples_per_batch);
  return most;
}

SampleGrid EpochLog::grid_of(std::uint64_t sample) const {
  const auto later = std::upper_bound(grids_.begin(), grids_.end(), sample,
                                      [](std::uint64_t s, const SampleGrid& grid) { return s < grid.first; });
  return *(later == grids_.begin() ? later : later - 1);
}

node::Parameters EpochLog::parameters() const {
  node::Parameters parameters = node::to_parameters(configuration);
  if (start_) node::set_live(node::to_live(*start_), parameters);
  return parameters;
}

node::RunDigest EpochLog::digest() const {
  return start_ ? node::RunDigest(start_->digest) : node::RunDigest(configuration);
}

double EpochLog::drag_velocity() const { return start_ ? start_->drag_velocity : configuration.drag_velocity; }

// Whether the commands do, as far as a checkpoint counts them.
bool EpochLog::reaches_back() const {
  if (checkpoints.empty()) return true;  // reported by the commands themselves
  const auto& c = checkpoints.front();
  const auto first_drag = c.next_drag - static_cast<std::uint32_t>(c.drags);
  const auto first_change = c.next_parameters - static_cast<std::uint32_t>(node::changes_before(c));
  return !drags.empty() && drags.front().header.seq == first_drag && !changes.empty() &&
         changes.front().header.seq == first_change;
}

// The last checkpoint before the first batch of the recording, as then the least is to be simulated. Later epochs are
// in it from their beginnings on.
void EpochLog::choose_start(const FirstBatch& first) {
  for (const auto& c : checkpoints) {
    const bool before =
        c.samples <= first.sample && c.impacts <= first.impact && node::from_message(c.time) < first.end;
    if (configuration.epoch < first.epoch || (configuration.epoch == first.epoch && before)) start_ = c;
  }
  if (start_ && node::from_message(start_->time) == ModelTime{} && reaches_back()) start_.reset();
  if (start_) {
    emulator_ = restore(*start_, configuration);
  } else {
    emulator_.emplace(node::emulator_settings(configuration));
  }
}

// What remains must follow on.
void EpochLog::drop_before_start() {
  const auto drop = [this](auto& messages, std::uint32_t next, const char* what) {
    const auto after =
        std::find_if(messages.begin(), messages.end(), [&](const auto& m) { return m.header.seq >= next; });
    messages.erase(messages.begin(), after);
    if (!messages.empty() && messages.front().header.seq != next) {
      missing(configuration.epoch, std::string(what) + " after the checkpoint that it begins with are missing");
    }
  };
  drop(drags, start_->next_drag, "commands");
  drop(changes, start_->next_parameters, "changes of parameters");
}

void EpochLog::merge() {
  commands.clear();
  std::size_t next = 0;
  for (const auto& change : changes) {
    if (change.first_command < drags_before() || change.first_command - drags_before() > drags.size()) {
      missing(change.epoch, "commands before a change of parameters are missing");
    }
    for (; next < change.first_command - drags_before(); ++next) commands.emplace_back(drags[next]);
    commands.emplace_back(change);
  }
  for (; next < drags.size(); ++next) commands.emplace_back(drags[next]);
}

void EpochLog::put_in_order(const FirstBatch& first) {
  check_configuration(configuration);
  choose_start(first);
  if (start_) drop_before_start();
  grids_ = {emulator_->grid()};
  check_drags();
  merge();
  check_changes();
  check_levels();
  ModelTime last = emulator_->now();
  for (const Applied& command : commands) {
    const ModelTime time = time_of(command);
    if (!(last <= time) || !(time.phase >= 0.0 && time.phase < 1.0)) {
      nonsense(configuration.epoch, "the model times of the commands do not rise");
    }
    last = time;
  }
}

void EpochLog::check_drags() const {
  if (!start_ && (drags.empty() || !(node::from_message(drags.front().time) == ModelTime{}))) {
    missing(configuration.epoch, "the history of commands does not reach back to its beginning");
  }
  for (const auto& drag : drags) {
    if (!(std::abs(drag.drag_velocity) <= configuration.max_drag_velocity)) {
      nonsense(configuration.epoch, "a command is beyond max_drag_velocity");
    }
  }
}

// Only auto takes levels of its own.
void EpochLog::check_levels() const {
  const Level configured = node::full_level(node::to_parameters(configuration));
  for (const Applied& command : commands) {
    std::visit(
        [&](const auto& applied) {
          Level level;
          const bool known = parse(applied.model, level.kind);
          level.contact_tolerance = applied.contact_tolerance;
          const bool possible = known && has_valid_tolerance(level);
          if (!possible || (configuration.model != node::kAuto && !(level == configured))) {
            nonsense(configuration.epoch, "a command brings a level of the model that the configuration has not");
          }
        },
        command);
  }
}

void EpochLog::check_changes() {
  const bool from_beginning = !start_ && !changes.empty();
  if (from_beginning && !(node::from_message(changes.front().time) == ModelTime{})) {
    missing(configuration.epoch, "the history of changes of parameters does not reach back to its beginning");
  }
  const node::Parameters parameters = node::to_parameters(configuration);
  if (from_beginning && !(node::to_live(changes.front()) == node::live_parameters(parameters))) {
    nonsense(configuration.epoch, "it does not begin with the live parameters of its configuration");
  }
  for (const auto& change : changes) {
    check_change(change, parameters);
    if (!fits(change, grids_.back())) nonsense(change.epoch, "a change of parameters is not between its samples");
    if (change.sample_period_tau != grids_.back().period) {
      grids_.push_back({change.sample_period_tau, change.first_sample, node::from_message(change.time)});
    }
  }
}

}  // namespace afm::replay
