// The tables of basins and orbits, for the tools and the Python module: their columns, and the cells of a row from left
// to right. A table takes numbers and text by `<<` and the end of a row by end_row(), as TableWriter does.
// Natural units.
#pragma once

#include <complex>
#include <vector>

#include "afm/dynamics/basins.h"
#include "afm/dynamics/periodic_orbit.h"
#include "common/table_units.h"

namespace afm {

const std::vector<Column>& basin_columns();
const std::vector<Column>& orbit_columns();

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
  for (const std::complex<double>& multiplier : orbit.multipliers) to << multiplier.real() << multiplier.imag();
  to.end_row();
}

}  // namespace afm
