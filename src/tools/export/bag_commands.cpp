#include "bag_commands.h"

#include <afm_emulator/AppliedDrag.h>
#include <afm_emulator/AppliedParameters.h>
#include <afm_emulator/Configuration.h>

#include <algorithm>
#include <limits>
#include <map>
#include <set>
#include <tuple>

#include "messages_of.h"
#include "node/wire/message_conversion.h"
#include "node/wire/topics.h"
#include "tools/replay/applied.h"

namespace afm {
namespace {

using replay::Applied;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

std::uint32_t epoch_of(const Applied& applied) {
  return std::visit([](const auto& message) { return message.epoch; }, applied);
}

// Every part of a split recording begins with the commands before it: each is taken once, by its sequence number.
template <class Message>
void collect(const replay::Recording& recording, const char* topic, std::vector<Applied>& commands) {
  std::set<std::uint32_t> known;
  for_each_message<Message>(recording, topic, [&](const Message& message) {
    if (known.insert(message.header.seq).second) commands.emplace_back(message);
  });
}

std::vector<Applied> in_order(const replay::Recording& recording) {
  std::vector<Applied> commands;
  collect<afm_emulator::AppliedDrag>(recording, node::kAppliedDragTopic, commands);
  collect<afm_emulator::AppliedParameters>(recording, node::kAppliedParametersTopic, commands);
  const auto key = [](const Applied& a) {
    const ModelTime time = replay::time_of(a);
    return std::make_tuple(epoch_of(a), time.tau, time.phase);
  };
  std::stable_sort(commands.begin(), commands.end(),
                   [&](const Applied& a, const Applied& b) { return key(a) < key(b); });
  return commands;
}

// What the configuration says of the beginning of its epoch.
CommandRow beginning_of(const afm_emulator::Configuration& configuration) {
  CommandRow row;
  row.epoch = configuration.epoch;
  row.drag_velocity = configuration.drag_velocity;
  row.live = node::live_parameters(node::to_parameters(configuration));
  return row;
}

void apply(const afm_emulator::AppliedDrag& drag, CommandRow& row) { row.drag_velocity = drag.drag_velocity; }

void apply(const afm_emulator::AppliedParameters& change, CommandRow& row) { row.live = node::to_live(change); }

// A recording begun late does not hold the drag velocities before it: then that of the configuration was not in force.
bool drag_is_unknown(const Applied& applied, std::uint64_t drags_seen) {
  const auto* change = std::get_if<afm_emulator::AppliedParameters>(&applied);
  return change != nullptr && drags_seen == 0 && change->first_command > 0;
}

void apply(const Applied& applied, CommandRow& row) {
  row.time = replay::time_of(applied);
  std::visit(
      [&](const auto& message) {
        apply(message, row);
        row.model = message.model;
        row.contact_tolerance = message.contact_tolerance;
        row.first_impact = message.first_impact;
      },
      applied);
}

// Of several commands at one moment the row of the last one stays, as it holds them all.
void append(const CommandRow& row, std::vector<CommandRow>& rows) {
  if (!rows.empty() && rows.back().epoch == row.epoch && rows.back().time == row.time) rows.pop_back();
  rows.push_back(row);
}

}  // namespace

std::vector<CommandRow> commands_of(const replay::Recording& recording) {
  std::map<std::uint32_t, CommandRow> epochs;
  for_each_message<afm_emulator::Configuration>(recording, node::kConfigurationTopic, [&](const auto& configuration) {
    epochs.emplace(configuration.epoch, beginning_of(configuration));
  });
  std::vector<CommandRow> rows;
  CommandRow now;
  std::uint64_t drags = 0;
  for (const Applied& applied : in_order(recording)) {
    if (rows.empty() || epoch_of(applied) != now.epoch) {
      now = epochs[epoch_of(applied)];
      now.epoch = epoch_of(applied);
      drags = 0;
    }
    if (drag_is_unknown(applied, drags)) now.drag_velocity = kNaN;
    if (std::holds_alternative<afm_emulator::AppliedDrag>(applied)) ++drags;
    apply(applied, now);
    append(now, rows);
  }
  return rows;
}

}  // namespace afm
