#include "impact_filter.h"

#include <limits>
#include <stdexcept>
#include <vector>

#include "common/csv.h"
#include "common/table_writer.h"

namespace afm {
namespace {

constexpr std::size_t kInputs = 7, kOutputs = 8;
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

// The numbers of one row as they stand there; nan where there is none. Throws std::invalid_argument with every fault.
void parse_inputs(const std::string& line, const TableUnits& units, std::vector<double>& values) {
  const std::vector<std::string> fields = split_fields(line);
  if (fields.size() != kInputs) {
    throw std::invalid_argument("expected " + std::to_string(kInputs) + " fields, found " +
                                std::to_string(fields.size()));
  }
  std::string faults;
  for (std::size_t i = 0; i < kInputs; ++i) {
    if (parse_number(fields[i], values[i])) continue;
    values[i] = kNaN;
    const std::string name = units.name(kImpactColumns[i]);
    faults += (faults.empty() ? "" : "; ") + name + " = '" + fields[i] + "': not a number";
  }
  if (!faults.empty()) throw std::invalid_argument(faults);
}

// The state in natural units.
std::vector<double> to_natural(const std::vector<double>& inputs, const TableUnits& units) {
  std::vector<double> natural = inputs;
  for (std::size_t i = 0; i < kInputs; ++i) natural[i] = units.invert(kImpactColumns[i].quantity, inputs[i]);
  return natural;
}

// With every fault, named and valued as in the table.
void refuse_faults(const FlightInput& input, const TableUnits& units, const std::vector<double>& values) {
  std::string text;
  for (const ParameterError& fault : find_faults(input)) {
    std::string shown = fault.what();
    for (std::size_t i = 0; i < kInputs; ++i) {
      if (kImpactColumns[i].name != fault.name) continue;
      shown = ParameterError(units.name(kImpactColumns[i]), values[i], fault.reason).what();
    }
    text += (text.empty() ? "" : "; ") + shown;
  }
  if (!text.empty()) throw std::invalid_argument(text);
}

void compute_row(const FlightInput& tip, const std::string& line, const TableUnits& units, std::vector<double>& row) {
  parse_inputs(line, units, row);
  const std::vector<double> s = to_natural(row, units);
  FlightInput input = tip;
  input.eta = s[0], input.gamma = s[1], input.cutoff = s[2];
  input.phase = s[3], input.extension = s[4], input.u = s[5], input.w = s[6];
  refuse_faults(input, units, row);
  const FlightResult r = fly_to_next_impact(input);
  const double results[kOutputs] = {r.dt, r.phase,        r.extension,           r.u,
                                    r.w,  r.normal_speed, r.tangential_velocity, r.energy_loss};
  for (std::size_t i = 0; i < kOutputs; ++i) {
    row[kInputs + i] = units.convert(kImpactColumns[kInputs + i].quantity, results[i]);
  }
}

}  // namespace

using Q = Quantity;

const std::vector<Column> kImpactColumns{{"eta", Q::velocity, "drag_velocity"},
                                         {"gamma"},
                                         {"cutoff", Q::velocity},
                                         {"phase"},
                                         {"extension", Q::length},
                                         {"u", Q::velocity},
                                         {"w", Q::velocity},
                                         {"dt", Q::time},
                                         {"phase_next"},
                                         {"extension_next", Q::length},
                                         {"u_next", Q::velocity},
                                         {"w_next", Q::velocity},
                                         {"normal_speed", Q::velocity},
                                         {"tangential_velocity", Q::velocity},
                                         {"energy_loss", Q::energy}};

std::string impact_input_header(const TableUnits& units) {
  return units.header({kImpactColumns.begin(), kImpactColumns.begin() + kInputs});
}

std::string impact_output_header(const TableUnits& units) { return units.header(kImpactColumns); }

bool filter_impacts(const FlightInput& tip, std::istream& in, const std::string& name, std::ostream& out,
                    std::ostream& complaints, const TableUnits& units) {
  CsvLines lines(in);
  std::string line;
  const auto complain = [&](const std::string& what) {
    complaints << "next_impact: " << name << ":" << lines.number() << ": " << what << "\n";
    return false;
  };
  const std::string header = impact_input_header(units);
  if (!lines.next(line)) return complain("no header: expected '" + header + "', found nothing");
  if (split_fields(line) != split_fields(header)) {
    return complain("expected '" + header + "' as the header, found '" + line + "'");
  }
  TableWriter table(out, kImpactColumns, TableUnits::plain());  // a row is in the units of the table already
  bool good = true;
  while (lines.next(line)) {
    std::vector<double> row(kInputs + kOutputs, kNaN);
    try {
      compute_row(tip, line, units, row);
    } catch (const std::exception& fault) {
      good = complain(fault.what());
    }
    for (const double value : row) table << value;
    table.end_row();
  }
  if (in.bad()) return complain("cannot read on");
  return good;
}

}  // namespace afm
