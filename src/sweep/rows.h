// The table of a curve, for the tool and the Python module: its columns, and the cells of a row from left to right. A
// table takes numbers and text by `<<` and the end of a row by end_row(), as TableWriter does. Natural units.
#pragma once

#include <vector>

#include "afm/sweep.h"
#include "common/table_units.h"

namespace afm {

inline const std::vector<Column> kCurveColumns{{"eta", Quantity::velocity, "drag_velocity"},
                                               {"gamma"},
                                               {"cutoff", Quantity::velocity},
                                               {"k_f", Quantity::friction},
                                               {"k_f_std_error", Quantity::friction},
                                               {"impacts_per_tau"},
                                               {"mean_energy_loss", Quantity::energy},
                                               {"mean_flight_time", Quantity::time},
                                               {"largest_lyapunov", Quantity::rate},
                                               {"attractor"},
                                               {"rest_height", Quantity::length},
                                               {"amplitude", Quantity::length},
                                               {"frequency_ratio"},
                                               {"k_f_work", Quantity::friction},
                                               {"k_f_work_std_error", Quantity::friction}};

template <class Table>
void write_row(const SweepPoint& point, const SweepResult& r, Table& to) {
  const FrictionAverage& f = r.friction;
  to << point.eta << point.gamma << point.v_c << f.K_f << f.K_f_std_error << f.impacts_per_tau << f.mean_energy_loss
     << f.mean_flight_time << r.largest_lyapunov << r.attractor << point.y0 << point.H << point.frequency_ratio
     << f.K_f_work << f.K_f_work_std_error;
  to.end_row();
}

}  // namespace afm
