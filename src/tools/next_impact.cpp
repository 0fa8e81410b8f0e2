// A filter: states after an impact in, the next impact out.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <fstream>
#include <iostream>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include "csv.h"
#include "single_flight.h"

namespace {

const std::string kInputHeader = "eta,gamma,cutoff,phase,extension,u,w";
const std::string kOutputHeader =
    kInputHeader + ",dt,phase_next,extension_next,u_next,w_next,normal_speed,tangential_velocity,energy_loss";
constexpr std::size_t kInputs = 7, kOutputs = 8;
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

const char kDescription[] =
    "Computes the next impact of each state of a table.\n"
    "In:  CSV with the header eta,gamma,cutoff,phase,extension,u,w: drag velocity, restitution and its cutoff speed,\n"
    "     and a state just after an impact: surface phase, extension x - xc, lab velocity (units a, tau, tip mass).\n"
    "Out: the same columns, then dt,phase_next,extension_next,u_next,w_next (after the impact), normal_speed,\n"
    "     tangential_velocity (before it) and energy_loss. A row that cannot be computed gives nan and a message, and\n"
    "     exit code 1 at the end.";

// The numbers of one row; nan where there is none. Throws std::invalid_argument with every fault.
void parse_inputs(const std::string& line, std::vector<double>& values) {
  const std::vector<std::string> fields = afm::split_fields(line);
  if (fields.size() != kInputs) {
    throw std::invalid_argument("expected " + std::to_string(kInputs) + " fields, found " +
                                std::to_string(fields.size()));
  }
  std::string faults;
  for (std::size_t i = 0; i < kInputs; ++i) {
    if (afm::parse_number(fields[i], values[i])) continue;
    values[i] = kNaN;
    const std::string name = afm::split_fields(kInputHeader)[i];
    faults += (faults.empty() ? "" : "; ") + name + " = '" + fields[i] + "': not a number";
  }
  if (!faults.empty()) throw std::invalid_argument(faults);
}

void compute_row(afm::ModelKind kind, const std::string& line, std::vector<double>& row) {
  parse_inputs(line, row);
  const afm::FlightResult r = afm::fly_to_next_impact({row[0], row[1], row[2], row[3], row[4], row[5], row[6], kind});
  const double results[kOutputs] = {r.dt, r.phase,        r.extension,           r.u,
                                    r.w,  r.normal_speed, r.tangential_velocity, r.energy_loss};
  std::copy(results, results + kOutputs, row.begin() + kInputs);
}

bool is_header(const std::string& line) { return afm::split_fields(line) == afm::split_fields(kInputHeader); }

// Whether every row could be computed.
bool filter(afm::ModelKind kind, std::istream& in, const std::string& name) {
  afm::CsvLines lines(in);
  std::string line;
  const auto complain = [&](const std::string& what) {
    std::cerr << "next_impact: " << name << ":" << lines.number() << ": " << what << "\n";
    return false;
  };
  if (!lines.next(line)) return complain("no header: expected '" + kInputHeader + "', found nothing");
  if (!is_header(line)) return complain("no header: expected '" + kInputHeader + "', found '" + line + "'");
  bool good = true;
  while (lines.next(line)) {
    std::vector<double> row(kInputs + kOutputs, kNaN);
    try {
      compute_row(kind, line, row);
    } catch (const std::exception& fault) {
      good = complain(fault.what());
    }
    std::cout << afm::join_numbers(row) << "\n";
  }
  if (in.bad()) return complain("cannot read on");
  return good;
}

bool filter_file(afm::ModelKind kind, const std::string& path) {
  if (path == "-") return filter(kind, std::cin, "stdin");
  std::ifstream file(path);
  if (file) return filter(kind, file, path);
  std::cerr << "next_impact: cannot open '" << path << "'\n";
  return false;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{kDescription, "next_impact"};
  std::vector<std::string> paths;
  app.add_option("files", paths, "tables to read; none, or -, is standard input");
  std::string model = "oscillator";
  app.add_option("--model", model, "oscillator; or hammer, which has no extension, and eta for u")->capture_default_str();
  CLI11_PARSE(app, argc, argv);
  afm::ModelKind kind = afm::ModelKind::oscillator;
  if (!afm::parse(model, kind)) {
    std::cerr << "next_impact: model = " << model << ": must be oscillator or hammer\n";
    return 2;
  }
  if (paths.empty()) paths.emplace_back("-");

  std::cout << kOutputHeader << "\n";
  bool good = true;
  for (const std::string& path : paths) good = filter_file(kind, path) && good;
  std::cout.flush();
  if (!std::cout) std::cerr << "next_impact: cannot write the output\n";
  return good && std::cout ? 0 : 1;
}
