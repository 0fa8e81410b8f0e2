#include "rows.h"

namespace afm {
namespace {

using Q = Quantity;

const std::vector<Column> kCurveColumns{{"eta", Q::velocity, "drag_velocity"},
                                        {"gamma"},
                                        {"cutoff", Q::velocity},
                                        {"k_f", Q::friction},
                                        {"k_f_std_error", Q::friction},
                                        {"impacts_per_tau"},
                                        {"mean_energy_loss", Q::energy},
                                        {"mean_flight_time", Q::time},
                                        {"largest_lyapunov", Q::rate},
                                        {"attractor"},
                                        {"rest_height", Q::length},
                                        {"amplitude", Q::length},
                                        {"frequency_ratio"},
                                        {"k_f_work", Q::friction},
                                        {"k_f_work_std_error", Q::friction}};

}  // namespace

const std::vector<Column>& curve_columns() { return kCurveColumns; }

}  // namespace afm
