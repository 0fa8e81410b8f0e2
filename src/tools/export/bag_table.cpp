#include "bag_table.h"

#include <afm_emulator/Configuration.h>
#include <afm_emulator/Deflection.h>
#include <afm_emulator/Friction.h>
#include <afm_emulator/ImpactArray.h>

#include <functional>
#include <map>

#include "bag_commands.h"
#include "common/table_writer.h"
#include "messages_of.h"
#include "node/wire/message_conversion.h"
#include "node/wire/topics.h"

namespace afm {
namespace {

using replay::Problem;
using replay::Recording;
using replay::Verdict;
using Q = Quantity;

// Where and how a table is written.
struct Target {
  std::ostream& out;
  TableUnits table;
  double tau_s;
};

// Model time in whole tau and a phase is exact; the column beside them is rounded.
double seconds(const afm_emulator::ModelTime& time, double tau_s) {
  return (static_cast<double>(time.tau) + time.phase) * tau_s;
}

// The epoch and the time, and behind them what else the table holds.
TableWriter begin_table(const Target& to, const std::vector<Column>& rest) {
  std::vector<Column> columns{{"epoch"}, {"tau"}, {"phase"}, {"time", Q::time}};
  columns.insert(columns.end(), rest.begin(), rest.end());
  TableWriter table(to.out, columns, to.table);
  table.write_header();
  return table;
}

void begin_row(TableWriter& table, std::uint32_t epoch, const afm_emulator::ModelTime& time, double tau_s) {
  table << epoch << time.tau << time.phase << seconds(time, tau_s);
}

void write_impacts(const Recording& recording, const Target& to) {
  TableWriter table = begin_table(to, {{"index"},
                                       {"surface_phase"},
                                       {"normal_speed", Q::velocity},
                                       {"tangential_velocity", Q::velocity},
                                       {"energy_loss", Q::energy},
                                       {"kind"},
                                       {"count"}});
  for_each_message<afm_emulator::ImpactArray>(recording, node::kImpactsTopic, [&](const auto& batch) {
    std::uint64_t index = batch.first_index;
    for (const afm_emulator::Impact& i : batch.impacts) {
      begin_row(table, batch.epoch, i.time, to.tau_s);
      table << index++ << i.surface_phase << i.normal_speed << i.tangential_velocity << i.energy_loss
            << unsigned{i.kind} << i.count;
      table.end_row();
    }
  });
}

void write_deflection(const Recording& recording, const Target& to) {
  TableWriter table(to.out, {{"epoch"}, {"index"}, {"time", Q::time}, {"vertical", Q::length}, {"lateral", Q::length}},
                    to.table);
  table.write_header();
  for_each_message<afm_emulator::Deflection>(recording, node::kDeflectionTopic, [&](const auto& batch) {
    const double begin = seconds(batch.time, to.tau_s);
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

// Every field of the message but the count of impacts, and k_f_natural, which is k_f in the other units.
const std::vector<FrictionField> kFrictionFields{
    {{"drag_velocity", Q::velocity}, &afm_emulator::Friction::drag_velocity},
    {{"eta"}, &afm_emulator::Friction::eta},
    {{"force", Q::force}, &afm_emulator::Friction::force},
    {{"force_std_error", Q::force}, &afm_emulator::Friction::force_std_error},
    {{"k_f", Q::friction}, &afm_emulator::Friction::k_f},
    {{"k_f_std_error", Q::friction}, &afm_emulator::Friction::k_f_std_error},
    {{"energy_loss", Q::energy}, &afm_emulator::Friction::energy_loss},
    {{"window_force", Q::force}, &afm_emulator::Friction::window_force},
    {{"window_k_f", Q::friction}, &afm_emulator::Friction::window_k_f},
    {{"window_k_f_std_error", Q::friction}, &afm_emulator::Friction::window_k_f_std_error},
    {{"mean_lateral_force", Q::force}, &afm_emulator::Friction::mean_lateral_force},
    {{"mean_lateral_force_std_error", Q::force}, &afm_emulator::Friction::mean_lateral_force_std_error},
    {{"k_f_work", Q::friction}, &afm_emulator::Friction::k_f_work},
    {{"k_f_work_std_error", Q::friction}, &afm_emulator::Friction::k_f_work_std_error},
    {{"heat_to_bath", Q::energy}, &afm_emulator::Friction::heat_to_bath}};

void write_friction(const Recording& recording, const Target& to) {
  std::vector<Column> columns{{"impact_count"}};
  for (const FrictionField& field : kFrictionFields) columns.push_back(field.column);
  TableWriter table = begin_table(to, columns);
  for_each_message<afm_emulator::Friction>(recording, node::kFrictionTopic, [&](const auto& friction) {
    begin_row(table, friction.epoch, friction.time, to.tau_s);
    table << friction.impact_count;
    for (const FrictionField& field : kFrictionFields) table << friction.*field.value;
    table.end_row();
  });
}

void write_commands(const Recording& recording, const Target& to) {
  TableWriter table = begin_table(to, {{"drag_velocity", Q::velocity},
                                       {"restitution_gamma"},
                                       {"cutoff_speed", Q::velocity},
                                       {"rest_height", Q::length},
                                       {"sample_rate", Q::rate},
                                       {"friction_window_tau"},
                                       {"temperature", Q::temperature},
                                       {"quality_factor"},
                                       {"lateral_quality_factor"},
                                       {"kicks_per_tau"},
                                       {"model"},
                                       {"contact_tolerance"},
                                       {"first_impact"}});
  for (const CommandRow& row : commands_of(recording)) {
    begin_row(table, row.epoch, node::to_message(row.time), to.tau_s);
    table << row.drag_velocity;
    for (const node::LiveField& field : node::kLiveFields) table << row.live.*field.value;
    table << row.model << row.contact_tolerance << row.first_impact;
    table.end_row();
  }
}

const std::map<std::string, std::function<void(const Recording&, const Target&)>> kTables{
    {"impacts", write_impacts},
    {"deflection", write_deflection},
    {"friction", write_friction},
    {"commands", write_commands}};

bool same_units(const Units& a, const Units& b) {
  return a.length() == b.length() && a.time() == b.time() && a.friction() == b.friction();
}

}  // namespace

bool is_bag_table(const std::string& topic) { return kTables.count(topic) > 0; }

Units units_of(const Recording& recording) {
  std::vector<Units> found;
  for_each_message<afm_emulator::Configuration>(recording, node::kConfigurationTopic, [&](const auto& configuration) {
    found.emplace_back(node::si_model(configuration));
    if (same_units(found.front(), found.back())) return;
    throw Problem(Verdict::usage, recording.name() +
                                      ": holds runs with different lattice spacings, frequencies or tip "
                                      "masses: they need a table each");
  });
  if (found.empty())
    throw Problem(Verdict::foreign, recording.name() + ": holds no configuration of " + recording.node());
  return found.front();
}

void write_bag_table(const Recording& recording, const std::string& topic, bool natural, std::ostream& out) {
  const Units units = units_of(recording);
  const TableUnits table = natural ? TableUnits::into_natural(units) : TableUnits::si();
  kTables.at(topic)(recording, Target{out, table, units.time()});
}

}  // namespace afm
