#include "run_log.h"

#include <cmath>

#include "message_difference.h"
#include "message_stream.h"
#include "node/message_conversion.h"
#include "node/topics.h"

namespace afm::replay {
namespace {

// Bags that follow on repeat the history: the same must be told again.
template <class Message>
void check_repeated(const Message& known, const Message& again, const std::string& where) {
  const auto difference = find_difference(known, again);
  if (!difference) return;
  throw Problem(Verdict::altered, where + ": " + difference->field + " is " + difference->second + ", and was " +
                                      difference->first + " when it was told before");
}

[[noreturn]] void lost(const std::string& where, std::uint64_t count) {
  throw Problem(Verdict::missing, where + ": " + std::to_string(count) + " messages are missing");
}

[[noreturn]] void nonsense(std::uint32_t epoch, const std::string& what) {
  throw Problem(Verdict::altered, "epoch " + std::to_string(epoch) + ": " + what);
}

node::Parameters parameters_of(const afm_emulator::Configuration& c) {
  node::Parameters p;
  p.si = node::si_model(c);
  p.model = c.model;
  p.drag_velocity = c.drag_velocity;
  p.max_drag_velocity = c.max_drag_velocity;
  p.initial = {c.initial_phase, c.initial_extension, c.initial_height, c.initial_u, c.initial_w};
  p.time_scale = c.time_scale;
  p.batch_rate_hz = c.batch_rate_hz;
  p.sample_rate_hz = c.sample_rate_hz;
  p.friction_window_tau = c.friction_window_tau;
  p.impact_budget = c.impact_budget;
  p.contact_tolerance = c.contact_tolerance;
  return p;
}

// What a node would refuse to run, or would have derived in another way, is no configuration that ran.
void check_configuration(const afm_emulator::Configuration& c) {
  const node::Parameters parameters = parameters_of(c);
  const node::Faults faults = node::find_faults(parameters);
  if (!faults.empty()) nonsense(c.epoch, "its configuration cannot be run: " + node::describe(faults));
  const node::Label label{c.header.stamp, c.epoch};
  const auto derived = node::to_configuration(parameters, c.version, c.arithmetic_digest, label);
  if (const auto difference = find_difference(c, derived)) {
    nonsense(c.epoch, difference->field + " is " + difference->first + ", and from the rest of the configuration " +
                          difference->second + " follows");
  }
}

void check_commands(const EpochLog& log) {
  const auto& c = log.configuration;
  ModelTime last;
  if (log.commands.empty() || !(node::from_message(log.commands.front().time) == ModelTime{})) {
    throw Problem(Verdict::missing, "epoch " + std::to_string(c.epoch) +
                                        ": the history of commands does not reach back to its beginning");
  }
  for (const auto& command : log.commands) {
    const ModelTime time = node::from_message(command.time);
    if (!(last <= time) || !(time.phase >= 0.0 && time.phase < 1.0)) {
      nonsense(c.epoch, "the model times of the commands do not rise");
    }
    if (!(std::abs(command.drag_velocity) <= c.max_drag_velocity)) {
      nonsense(c.epoch, "a command is beyond max_drag_velocity");
    }
    last = time;
  }
}

}  // namespace

RunLog::RunLog(const Recording& recording) {
  for (const auto& bag : recording.bags()) {
    MessageStream<afm_emulator::Configuration> configurations(recording.topic(node::kConfigurationTopic));
    MessageStream<afm_emulator::AppliedDrag> commands(recording.topic(node::kAppliedDragTopic));
    configurations.add(bag->bag, bag->path);
    commands.add(bag->bag, bag->path);
    const auto where = [&](const auto& stream) { return bag->path + ": " + stream.topic(); };
    for (; configurations.head() != nullptr; configurations.pop()) take(*configurations.head(), where(configurations));
    take_all(commands, where(commands));
  }
  for (const auto& [number, log] : epochs_) {
    check_configuration(log.configuration);
    check_commands(log);
  }
}

const EpochLog& RunLog::epoch(std::uint32_t number) const {
  const auto found = epochs_.find(number);
  if (found != epochs_.end()) return found->second;
  throw Problem(Verdict::missing, "epoch " + std::to_string(number) + ": its configuration is missing");
}

void RunLog::take(const afm_emulator::Configuration& configuration, const std::string& where) {
  const auto known = epochs_.find(configuration.epoch);
  if (known != epochs_.end()) return check_repeated(known->second.configuration, configuration, where);
  if (last_configuration_ != nullptr) {
    const std::uint64_t gap = follows(last_configuration_->header.seq, configuration.header.seq, where);
    if (gap > 0) lost(where, gap);
    follows(last_configuration_->epoch, configuration.epoch, where + ": epoch");
  }
  EpochLog& log = epochs_[configuration.epoch];
  log.configuration = configuration;
  last_configuration_ = &log.configuration;
}

void RunLog::take_all(MessageStream<afm_emulator::AppliedDrag>& commands, const std::string& where) {
  std::optional<std::uint32_t> previous;  // in this bag
  for (; commands.head() != nullptr; commands.pop()) {
    const std::uint32_t sequence = commands.head()->header.seq;
    const std::uint64_t gap = previous ? follows(*previous, sequence, where) : 0;
    if (gap > 0) lost(where, gap);
    previous = sequence;
    take(*commands.head(), where);
  }
}

void RunLog::take(const afm_emulator::AppliedDrag& command, const std::string& where) {
  const std::uint32_t sequence = command.header.seq;
  epoch(command.epoch);
  auto& commands = epochs_[command.epoch].commands;
  if (last_command_ && sequence <= *last_command_) {
    const bool known = !commands.empty() && sequence >= commands.front().header.seq;
    const std::size_t index = known ? sequence - commands.front().header.seq : 0;
    if (known && index < commands.size()) return check_repeated(commands[index], command, where);
  }
  const std::uint64_t gap = last_command_ ? follows(*last_command_, sequence, where) : 0;
  if (gap > 0) lost(where, gap);
  last_command_ = sequence;
  commands.push_back(command);
}

}  // namespace afm::replay
