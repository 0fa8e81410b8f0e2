// The tables of basins and orbits, for the tools and the Python module: their columns, and the cells of a row from left
// to right. A table takes numbers and text by `<<` and the end of a row by end_row(), as TableWriter does.
// Natural units.
#pragma once

#include <complex>
#include <string>
#include <vector>

#include "afm/dynamics/basins.h"
#include "afm/dynamics/periodic_orbit.h"
#include "common/table_units.h"

namespace afm {

inline const std::vector<Column> kBasinColumns{{"eta", Quantity::velocity, "drag_velocity"},
                                               {"gamma"},
                                               {"cutoff", Quantity::velocity},
                                               {"attractor"},
                                               {"impacts"},
                                               {"cells"},
                                               {"k_f", Quantity::friction},
                                               {"k_f_std_error", Quantity::friction},
                                               {"lyapunov_1", Quantity::rate},
                                               {"lyapunov_2", Quantity::rate},
                                               {"lyapunov_3", Quantity::rate},
                                               {"lyapunov_4", Quantity::rate},
                                               {"rotation_number"},
                                               {"contact_share"},
                                               {"basin"},
                                               {"basin_std_error"},
                                               {"phase"},
                                               {"extension", Quantity::length},
                                               {"y", Quantity::length},
                                               {"u", Quantity::velocity},
                                               {"w", Quantity::velocity}};

// These columns and those of the multipliers.
inline std::vector<Column> with_multipliers(std::vector<Column> columns) {
  for (const char number : {'1', '2', '3', '4'}) {
    const std::string name = std::string("multiplier_") + number;
    columns.insert(columns.end(), {{name + "_re"}, {name + "_im"}});
  }
  return columns;
}

template <class Table>
void write_multipliers(const PeriodicOrbit& orbit, Table& to) {
  for (const std::complex<double>& multiplier : orbit.multipliers) to << multiplier.real() << multiplier.imag();
}

// The residual is in natural units always: the largest of errors of several kinds.
inline const std::vector<Column> kOrbitColumns = with_multipliers({{"length"},
                                                                   {"cells"},
                                                                   {"period", Quantity::time},
                                                                   {"k_f", Quantity::friction},
                                                                   {"residual"},
                                                                   {"phase"},
                                                                   {"extension", Quantity::length},
                                                                   {"u", Quantity::velocity},
                                                                   {"w", Quantity::velocity}});

template <class Table>
void write_row(const SweepPoint& point, const Basin& basin, Table& to) {
  const Attractor& a = basin.first.attractor;
  const FreeState start = to_free_state(model_of(point).H, basin.first.start);
  to << point.eta << point.gamma << point.v_c << a.name() << a.impacts << a.cells << basin.first.K_f
     << basin.first.K_f_std_error;
  for (const double exponent : a.lyapunov.exponents) to << exponent;
  to << a.rotation_number << a.contact_share << basin.share << basin.share_std_error << start.phase << start.X
     << start.y << start.u << start.w;
  to.end_row();
}

template <class Table>
void write_row(double H, const PeriodicOrbit& orbit, Table& to) {
  const FreeState first = to_free_state(H, orbit.points.front());
  to << orbit.length() << orbit.cells << orbit.period << orbit.K_f << orbit.residual << first.phase << first.X
     << first.u << first.w;
  write_multipliers(orbit, to);
  to.end_row();
}

}  // namespace afm
