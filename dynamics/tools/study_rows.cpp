#include "study_rows.h"

namespace afm {
namespace {

using Q = Quantity;

const std::vector<Column> kBasinColumns{{"eta", Q::velocity, "drag_velocity"},
                                        {"gamma"},
                                        {"cutoff", Q::velocity},
                                        {"attractor"},
                                        {"impacts"},
                                        {"cells"},
                                        {"k_f", Q::friction},
                                        {"k_f_std_error", Q::friction},
                                        {"lyapunov_1", Q::rate},
                                        {"lyapunov_2", Q::rate},
                                        {"lyapunov_3", Q::rate},
                                        {"lyapunov_4", Q::rate},
                                        {"rotation_number"},
                                        {"contact_share"},
                                        {"basin"},
                                        {"basin_std_error"},
                                        {"phase"},
                                        {"extension", Q::length},
                                        {"y", Q::length},
                                        {"u", Q::velocity},
                                        {"w", Q::velocity}};

// The residual is in natural units always: the largest of errors of several kinds.
const std::vector<Column> kOrbitColumns{
    {"length"},          {"cells"},           {"period", Q::time},      {"k_f", Q::friction},
    {"residual"},        {"phase"},           {"extension", Q::length}, {"u", Q::velocity},
    {"w", Q::velocity},  {"multiplier_1_re"}, {"multiplier_1_im"},      {"multiplier_2_re"},
    {"multiplier_2_im"}, {"multiplier_3_re"}, {"multiplier_3_im"},      {"multiplier_4_re"},
    {"multiplier_4_im"}};

}  // namespace

const std::vector<Column>& basin_columns() { return kBasinColumns; }
const std::vector<Column>& orbit_columns() { return kOrbitColumns; }

}  // namespace afm
