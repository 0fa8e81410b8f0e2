// A filter: states after an impact in, the next impact out.
#include <fstream>
#include <iostream>
#include <string>
#include <vector>

#include "common/command_line.h"
#include "common/point_options.h"
#include "impact_filter.h"

namespace {

const char kDescription[] =
    "Computes the next impact of each state of a table.\n"
    "In:  CSV with the header eta,gamma,cutoff,phase,extension,u,w: drag velocity, restitution and its cutoff speed,\n"
    "     and a state just after an impact: surface phase, extension x - xc, lab velocity (units a, tau, tip mass).\n"
    "Out: the same columns, then dt,phase_next,extension_next,u_next,w_next (after the impact), normal_speed,\n"
    "     tangential_velocity (before it) and energy_loss. With --si the header is drag_velocity_m_per_s,gamma,\n"
    "     cutoff_m_per_s,phase,extension_m,u_m_per_s,w_m_per_s, and the columns that come out are named alike. A row\n"
    "     that cannot be computed gives nan and a message, and exit code 1 at the end.\n"
    "The lever and its surface are options. The hammer has no extension, and eta for u.";

bool filter_file(const afm::FlightInput& tip, const std::string& path, const afm::TableUnits& units) {
  if (path == "-") return afm::filter_impacts(tip, std::cin, "stdin", std::cout, std::cerr, units);
  std::ifstream file(path);
  if (file) return afm::filter_impacts(tip, file, path, std::cout, std::cerr, units);
  std::cerr << "next_impact: cannot open '" << path << "'\n";
  return false;
}

}  // namespace

int main(int argc, char** argv) {
  afm::CommandLine app("next_impact", kDescription);
  std::vector<std::string> paths;
  app.arguments("files", paths, "tables to read; none, or -, is standard input");
  afm::PointOptions options;  // but for what stands in the table
  afm::add_tip_options(app, options);
  afm::add_tip_si_options(app, options);
  return app.run(argc, argv, [&] {
    if (paths.empty()) paths.emplace_back("-");
    afm::take_tip_si(app, options);
    const afm::SweepPoint point = afm::checked_point(app, options);
    afm::FlightInput tip{};
    tip.kind = point.kind;
    tip.rest_height = point.y0;
    tip.amplitude = point.H;
    tip.frequency_ratio = point.frequency_ratio;
    const afm::TableUnits units = afm::table_units(options.si);
    std::cout << impact_output_header(units) << "\n";
    bool good = true;
    for (const std::string& path : paths) good = filter_file(tip, path, units) && good;
    return good ? 0 : 1;
  });
}
