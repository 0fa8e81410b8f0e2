// A topic of a recording as CSV, for any other program.
#include <afm_emulator/Applied.h>
#include <afm_emulator/Configuration.h>
#include <afm_emulator/Deflection.h>
#include <afm_emulator/Friction.h>
#include <afm_emulator/ImpactArray.h>
#include <afm_emulator/Snapshot.h>

#include <functional>
#include <iostream>
#include <map>
#include <optional>
#include <set>
#include <stdexcept>
#include <string>
#include <tuple>
#include <vector>

#include "common/command_line.h"
#include "common/table_writer.h"
#include "node/params/table.h"
#include "node/publisher/messages.h"
#include "tools/bags/recording.h"

namespace {

using afm::Column;
using afm::TableWriter;
using afm::bags::Problem;
using afm::bags::Recording;
using Q = afm::Quantity;

const char kDescription[] =
    "Writes one topic of a recording as CSV to the standard output, in SI, 17 digits. The names of the columns have\n"
    "the units. Topics:\n"
    "  impacts     epoch, model time (whole tau and a phase, exact; time: both together, rounded), running index,\n"
    "              surface phase, normal speed, tangential velocity, energy loss, kind (0 impact, 1 chatter sequence,\n"
    "              2 contact begun, 3 contact ended) and the count of bounces that it stands for\n"
    "  deflection  epoch, running index, time, vertical, lateral: a row for each sample\n"
    "  friction    the estimates of afm_emulator/Friction, a row for each batch\n"
    "  commands    a row for everything that took effect: all that is in force from there on\n"
    "Lost messages show as gaps in the running index.\n"
    "Exit codes: 0 written; 1 the output cannot be written; 2 wrong arguments; 3 something is missing, or the bag\n"
    "cannot be read: stderr says what, and all is written up to what cannot be read.";

constexpr int kIncomplete = 3;

struct Target {
  afm::TableUnits units;
  double tau_s;

  // The epoch and the time, and behind them what else the table holds.
  TableWriter begin(const std::vector<Column>& rest, bool exact_time = true) const {
    std::vector<Column> columns{{"epoch"}};
    if (exact_time) columns.insert(columns.end(), {{"tau"}, {"phase"}, {"time", Q::time}});
    columns.insert(columns.end(), rest.begin(), rest.end());
    TableWriter table(std::cout, columns, units);
    table.write_header();
    return table;
  }
  double seconds(const afm_emulator::ModelTime& time) const {
    return (static_cast<double>(time.tau) + time.phase) * tau_s;
  }
  void begin_row(TableWriter& table, std::uint32_t epoch, const afm_emulator::ModelTime& time) const {
    table << epoch << time.tau << time.phase << seconds(time);
  }
};

// write(message) for each that is held. Returns how many messages are lost; says what else the user should know.
template <class Message, class Write>
std::uint64_t write_each(const Recording& recording, const Write& write) {
  if (!recording.holds<Message>()) throw Problem(recording.name() + ": holds no messages of this topic");
  std::uint64_t lost = 0;
  std::set<std::uint64_t> starts;  // of the node
  for (const auto messages = recording.read<Message>(); messages->get(); messages->next()) {
    lost += messages->lost();
    starts.insert(messages->number().start);
    write(*messages->get());
  }
  const Recording::Missing ends = recording.missing_at_ends<Message>();
  const auto note = [](std::uint64_t count, const std::string& what) {
    std::cout.flush();
    std::cerr << "bag_to_csv: note: " << count << what << "\n";
  };
  if (ends.tolerated > 0) {
    note(ends.tolerated, " batches at the ends have no message of " + recording.topic<Message>());
  }
  if (starts.size() > 1) {
    note(starts.size(), " starts of the node: at each, epochs and the index begin again");
  }
  return lost + ends.at_beginning + ends.at_end;
}

std::uint64_t write_impacts(const Recording& recording, const Target& to) {
  TableWriter table = to.begin({{"index"},
                                {"surface_phase"},
                                {"normal_speed", Q::velocity},
                                {"tangential_velocity", Q::velocity},
                                {"energy_loss", Q::energy},
                                {"kind"},
                                {"count"}});
  return write_each<afm_emulator::ImpactArray>(recording, [&](const auto& batch) {
    std::uint64_t index = batch.first_index;
    for (const afm_emulator::Impact& i : batch.impacts) {
      to.begin_row(table, batch.epoch, i.time);
      table << index++ << i.surface_phase << i.normal_speed << i.tangential_velocity << i.energy_loss
            << unsigned{i.kind} << i.count;
      table.end_row();
    }
  });
}

std::uint64_t write_deflection(const Recording& recording, const Target& to) {
  TableWriter table = to.begin({{"index"}, {"time", Q::time}, {"vertical", Q::length}, {"lateral", Q::length}}, false);
  return write_each<afm_emulator::Deflection>(recording, [&](const auto& batch) {
    const double begin = to.seconds(batch.time);
    for (std::size_t i = 0; i < batch.vertical.size() && i < batch.lateral.size(); ++i) {
      table << batch.epoch << batch.first_sample + i << begin + static_cast<double>(i) * batch.sample_period
            << batch.vertical[i] << batch.lateral[i];
      table.end_row();
    }
  });
}

struct FrictionField {
  Column column;
  double afm_emulator::Friction::*value;
};

// Not those that are others in natural units.
#define AFM_FIELD(name, quantity) \
  { {#name, quantity}, &afm_emulator::Friction::name }
const std::vector<FrictionField> kFrictionFields{AFM_FIELD(drag_velocity, Q::velocity),
                                                 AFM_FIELD(eta, Q::number),
                                                 AFM_FIELD(force, Q::force),
                                                 AFM_FIELD(force_std_error, Q::force),
                                                 AFM_FIELD(k_f, Q::friction),
                                                 AFM_FIELD(k_f_std_error, Q::friction),
                                                 AFM_FIELD(energy_loss, Q::energy),
                                                 AFM_FIELD(window_force, Q::force),
                                                 AFM_FIELD(window_k_f, Q::friction),
                                                 AFM_FIELD(window_k_f_std_error, Q::friction),
                                                 AFM_FIELD(mean_lateral_force, Q::force),
                                                 AFM_FIELD(mean_lateral_force_std_error, Q::force),
                                                 AFM_FIELD(k_f_work, Q::friction),
                                                 AFM_FIELD(k_f_work_std_error, Q::friction),
                                                 AFM_FIELD(mean_normal_force, Q::force),
                                                 AFM_FIELD(heat_to_bath, Q::energy)};
#undef AFM_FIELD

std::uint64_t write_friction(const Recording& recording, const Target& to) {
  std::vector<Column> columns{{"impact_count"}};
  for (const FrictionField& field : kFrictionFields) columns.push_back(field.column);
  TableWriter table = to.begin(columns);
  return write_each<afm_emulator::Friction>(recording, [&](const auto& friction) {
    to.begin_row(table, friction.epoch, friction.time);
    table << friction.impact_count;
    for (const FrictionField& field : kFrictionFields) table << friction.*field.value;
    table.end_row();
  });
}

// The column of a parameter, whose name ends in its unit. The table gives units in its own way.
Column column_of(std::string name) {
  const auto take_end = [&](const std::string& end) {
    const bool found = name.size() > end.size() && name.compare(name.size() - end.size(), end.size(), end) == 0;
    if (found) name.resize(name.size() - end.size());
    return found;
  };
  const bool is_speed = name.find("_speed") != std::string::npos;
  const Q quantity = is_speed          ? Q::velocity
                     : take_end("_m")  ? Q::length
                     : take_end("_hz") ? Q::rate
                     : take_end("_k")  ? Q::temperature
                                       : Q::number;
  return {name, quantity};
}

template <class Message>
auto place(const Message& message, const afm_emulator::ModelTime& time) {
  return std::make_tuple(message.epoch, time.tau, time.phase);
}

template <class Message>
using ByStart = std::map<std::uint64_t, boost::shared_ptr<Message>>;  // of the node

// Before the first command that is held: those behind the first snapshot of its start and epoch. A snapshot from before
// the first batch is a latched one, in a bag that was begun later.
std::uint64_t count_lost_first_commands(const Recording& recording, ByStart<afm_emulator::Applied> commands,
                                        const ByStart<afm_emulator::Friction>& batches) {
  std::uint64_t lost = 0;
  for (const auto m = recording.read<afm_emulator::Snapshot>(); m->get(); m->next()) {
    const auto first = commands.find(m->number().start);
    const auto begin = batches.find(m->number().start);
    if (first == commands.end() || begin == batches.end() || m->get()->epoch != first->second->epoch) continue;
    if (place(*m->get(), m->get()->time) < place(*begin->second, begin->second->begin)) continue;
    const std::uint64_t known = m->get()->applied.number, number = first->second->number;
    if (number > known) lost += number - known - 1;
    commands.erase(first);
  }
  return lost;
}

// Of which no number between two others tells: at each start of the node the first ones, and the last one, of which
// friction tells.
std::uint64_t count_lost_commands_at_ends(const Recording& recording) {
  ByStart<afm_emulator::Applied> first, last;
  for (const auto m = recording.read<afm_emulator::Applied>(); m->get(); m->next()) {
    first.emplace(m->number().start, m->get());
    last[m->number().start] = m->get();
  }
  ByStart<afm_emulator::Friction> first_batch;
  std::set<std::uint64_t> lacking;
  boost::shared_ptr<afm_emulator::Friction> before;
  std::uint64_t start = 0;
  for (const auto m = recording.read<afm_emulator::Friction>(); m->get(); m->next()) {
    if (m->number().start != start) before.reset();
    start = m->number().start;
    first_batch.emplace(start, m->get());
    const auto command = last.find(start);
    // at one time there may be several impacts, and a batch of no length before the command
    const bool is_behind =
        before && (command == last.end() ||
                   std::make_pair(place(*before, before->begin), before->first_impact) >=
                       std::make_pair(place(*command->second, command->second->time), command->second->first_impact));
    if (is_behind && afm::bags::tells_of_command(*before, *m->get())) lacking.insert(start);
    before = m->get();
  }
  return lacking.size() + count_lost_first_commands(recording, first, first_batch);
}

std::uint64_t write_commands(const Recording& recording, const Target& to) {
  std::vector<Column> columns{{"drag_velocity", Q::velocity}};
  for (const char* name : afm::node::kLiveNames) columns.push_back(column_of(name));
  columns.insert(columns.end(), {{"model"}, {"contact_tolerance"}, {"first_impact"}, {"number"}, {"cause"}});
  TableWriter table = to.begin(columns);
  afm::node::Live unused;
  std::uint64_t lost = recording.commands_missing_at_beginning();
  lost += write_each<afm_emulator::Applied>(recording, [&](const auto& applied) {
    to.begin_row(table, applied.epoch, applied.time);
    table << applied.drag_velocity;
    afm::node::for_each_live(applied, unused, [&](double value, double) { table << value; });
    table << applied.model << applied.contact_tolerance << applied.first_impact << applied.number << applied.cause;
    table.end_row();
  });
  return lost + count_lost_commands_at_ends(recording);
}

const std::map<std::string, std::function<std::uint64_t(const Recording&, const Target&)>> kTables{
    {"impacts", write_impacts},
    {"deflection", write_deflection},
    {"friction", write_friction},
    {"commands", write_commands}};

// From its configurations and snapshots; tables of runs in different units would mix.
afm::Units units_of(const Recording& recording) {
  std::optional<afm::Units> units;
  const auto add = [&](const afm_emulator::Configuration& configuration) {
    const afm::Units found(afm::node::to_parameters(configuration).si);
    if (units &&
        (units->length() != found.length() || units->time() != found.time() || units->friction() != found.friction())) {
      throw Problem(recording.name() + ": holds runs with different lattice spacings, frequencies or tip masses");
    }
    units = found;
  };
  for (const auto m = recording.read<afm_emulator::Configuration>(); m->get(); m->next()) add(*m->get());
  for (const auto m = recording.read<afm_emulator::Snapshot>(); m->get(); m->next()) add(m->get()->configuration);
  if (!units) throw Problem(recording.name() + ": holds neither a configuration nor a snapshot, which have the units");
  return *units;
}

// The bags must be the parts of one recording, as rows of two would mix.
int write(const std::vector<std::string>& paths, const std::string& node, const std::string& topic, bool natural) {
  const auto recordings = afm::bags::open_recordings(paths, node);
  if (recordings.size() > 1) {
    throw std::invalid_argument(recordings[1].name() + " does not go on where " + recordings[0].name() +
                                " ends: give the bags of one recording, and --node where there are several");
  }
  const Recording& recording = recordings.front();
  const afm::Units units = units_of(recording);
  const Target to{natural ? afm::TableUnits::into_natural(units) : afm::TableUnits::si(), units.time()};
  if (!recording.holds<afm_emulator::Friction>() && topic != "friction") {
    std::cerr << "bag_to_csv: note: " << recording.name()
              << " holds no message of friction: what is missing at its ends is not known\n";
  }
  const std::uint64_t lost = kTables.at(topic)(recording, to);
  if (lost == 0) return 0;
  std::cout.flush();
  std::cerr << "bag_to_csv: warning: " << lost << " messages of " << topic << " are missing\n";
  return kIncomplete;
}

}  // namespace

int main(int argc, char** argv) {
  std::ios::sync_with_stdio(false);
  afm::CommandLine app("bag_to_csv", kDescription);
  std::vector<std::string> paths;
  std::string topic, node;
  bool natural = false;
  app.arguments("bags", paths, "a recording; of a split one all bags");
  app.option("topic", topic, "impacts, deflection, friction or commands");
  app.flag("natural", natural, "in lattice spacings a, periods tau and tip masses m_tip instead of SI");
  app.option("node", node, "the emulator's name such as /afm, where a bag holds several");
  return app.run(argc, argv, [&] {
    if (paths.empty()) throw std::invalid_argument("bags: must be given");
    if (kTables.count(topic) == 0) {
      throw std::invalid_argument("topic = " + topic + ": must be impacts, deflection, friction or commands");
    }
    try {
      return write(paths, node, topic, natural);
    } catch (const std::invalid_argument&) {
      throw;
    } catch (const std::exception& error) {
      std::cout.flush();
      std::cerr << "bag_to_csv: " << error.what() << "\n";
      return kIncomplete;
    }
  });
}
