// Any text into next_impact: no crash, a row out for every row in, nan for exactly those that are complained of.
#include <cmath>
#include <sstream>

#include "common/csv.h"
#include "target.h"
#include "tools/impact_filter.h"

namespace {

using afm::fuzz::require;

std::size_t lines_in(const std::string& text) {
  std::size_t n = 0;
  for (const char c : text) n += c == '\n' ? 1 : 0;
  return n;
}

// A row that was computed: an impact later in time, from which the tip leaves, and which has lost energy.
void check(const std::vector<double>& row) {
  for (const double value : row) require(std::isfinite(value), "a computed row is not finite");
  require(row[7] > 0.0, "the next impact is not later");
  require(row[8] >= 0.0 && row[8] < 1.0, "the phase is no phase");
  require(row[12] >= 0.0 && row[14] >= 0.0, "normal speed and energy lost cannot be negative");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::string text(reinterpret_cast<const char*>(data), size);
  afm::FlightInput tip{};
  if (size > 0 && data[0] == '#') tip.kind = afm::ModelKind::hammer;
  // mostly of rows, not of headers
  if (size > 0 && data[0] != '!') text = afm::impact_input_header() + "\n" + text;
  std::istringstream in(text);
  std::ostringstream out, complaints;
  const bool good = afm::filter_impacts(tip, in, "fuzz", out, complaints);
  std::size_t computed = 0, rows = 0;
  std::istringstream back(out.str());
  for (std::string line; std::getline(back, line); ++rows) {
    std::vector<double> row;
    for (const std::string& field : afm::split_fields(line)) {
      row.push_back(0.0);
      require(afm::parse_number(field, row.back()), "a field is no number: " + field);
    }
    require(row.size() == 15, "a row has not 15 fields");
    if (std::isnan(row[7])) continue;
    check(row);
    ++computed;
  }
  require(good == complaints.str().empty(), "complaints and the answer do not go together");
  if (rows > 0) require(rows - computed <= lines_in(complaints.str()), "a row was dropped in silence");
  return 0;
}
