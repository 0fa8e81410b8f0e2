#include "impact_filter.h"

#include <algorithm>
#include <limits>
#include <stdexcept>
#include <vector>

#include "common/csv.h"
#include "single_flight.h"

namespace afm {
namespace {

constexpr std::size_t kInputs = 7, kOutputs = 8;
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

// The numbers of one row; nan where there is none. Throws std::invalid_argument with every fault.
void parse_inputs(const std::string& line, std::vector<double>& values) {
  const std::vector<std::string> fields = split_fields(line);
  if (fields.size() != kInputs) {
    throw std::invalid_argument("expected " + std::to_string(kInputs) + " fields, found " +
                                std::to_string(fields.size()));
  }
  std::string faults;
  for (std::size_t i = 0; i < kInputs; ++i) {
    if (parse_number(fields[i], values[i])) continue;
    values[i] = kNaN;
    const std::string name = split_fields(kImpactInputHeader)[i];
    faults += (faults.empty() ? "" : "; ") + name + " = '" + fields[i] + "': not a number";
  }
  if (!faults.empty()) throw std::invalid_argument(faults);
}

void compute_row(ModelKind kind, const std::string& line, std::vector<double>& row) {
  parse_inputs(line, row);
  const FlightResult r = fly_to_next_impact({row[0], row[1], row[2], row[3], row[4], row[5], row[6], kind});
  const double results[kOutputs] = {r.dt, r.phase,        r.extension,           r.u,
                                    r.w,  r.normal_speed, r.tangential_velocity, r.energy_loss};
  std::copy(results, results + kOutputs, row.begin() + kInputs);
}

bool is_header(const std::string& line) { return split_fields(line) == split_fields(kImpactInputHeader); }

}  // namespace

const std::string kImpactInputHeader = "eta,gamma,cutoff,phase,extension,u,w";
const std::string kImpactOutputHeader =
    kImpactInputHeader + ",dt,phase_next,extension_next,u_next,w_next,normal_speed,tangential_velocity,energy_loss";

bool filter_impacts(ModelKind kind, std::istream& in, const std::string& name, std::ostream& out,
                    std::ostream& complaints) {
  CsvLines lines(in);
  std::string line;
  const auto complain = [&](const std::string& what) {
    complaints << "next_impact: " << name << ":" << lines.number() << ": " << what << "\n";
    return false;
  };
  if (!lines.next(line)) return complain("no header: expected '" + kImpactInputHeader + "', found nothing");
  if (!is_header(line)) return complain("no header: expected '" + kImpactInputHeader + "', found '" + line + "'");
  bool good = true;
  while (lines.next(line)) {
    std::vector<double> row(kInputs + kOutputs, kNaN);
    try {
      compute_row(kind, line, row);
    } catch (const std::exception& fault) {
      good = complain(fault.what());
    }
    out << join_numbers(row) << "\n";
  }
  if (in.bad()) return complain("cannot read on");
  return good;
}

}  // namespace afm
