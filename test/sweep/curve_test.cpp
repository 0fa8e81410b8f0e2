// A curve or map: which start and which kicks a row has, and what stands in its columns.
#include <gtest/gtest.h>

#include <atomic>
#include <map>
#include <string>

#include "sweep/grid.h"
#include "sweep/rows.h"

namespace afm {
namespace {

class Curve : public testing::TestWithParam<SweepDirection> {};

TEST_P(Curve, ARowIsThePointFromItsStartWithKicksOfItsOwn) {
  CurveSettings settings;
  settings.eta = {2.0, 2.5, 3.0}, settings.gamma = {0.6, 0.7}, settings.cutoff = {0.1};
  settings.direction = GetParam();
  settings.sweep.duration = 20.0, settings.sweep.transient = 5.0, settings.sweep.seed = 7;
  settings.sweep.bath.temperature = 0.9, settings.sweep.bath.quality_factor = 100.0;
  std::atomic<std::size_t> done{0};
  for (std::size_t begin = 0; begin < settings.size(); begin += settings.chain_length()) {
    TipState start = random_start(settings.at(begin), 7, begin);
    std::size_t row = begin;
    for (const SweepResult& result : compute_chain(settings, begin, done)) {
      SweepSettings own = settings.sweep;
      own.bath.stream = row;
      EXPECT_EQ(result.friction.K_f, sweep_point(settings.at(row), own, start).friction.K_f) << row;
      start = result.end;
      ++row;
    }
  }
  EXPECT_EQ(done, 6u);
}

INSTANTIATE_TEST_SUITE_P(Directions, Curve,
                         testing::Values(SweepDirection::fresh, SweepDirection::up, SweepDirection::down));

// The numbers of a row, by the names of their columns.
struct Cells {
  std::map<std::string, double> numbers;
  std::size_t column = 0;

  Cells& operator<<(double number) {
    numbers[kCurveColumns.at(column++).name] = number;
    return *this;
  }
  Cells& operator<<(const std::string&) {
    EXPECT_EQ(kCurveColumns.at(column++).name, "attractor");
    return *this;
  }
  void end_row() const { EXPECT_EQ(column, kCurveColumns.size()); }
};

TEST(CurveColumns, HoldWhatTheyAreCalled) {
  SweepPoint p{};
  SweepResult r;
  FrictionAverage& f = r.friction;
  const std::map<std::string, double*> fields{{"eta", &p.eta},
                                              {"gamma", &p.gamma},
                                              {"cutoff", &p.v_c},
                                              {"k_f", &f.K_f},
                                              {"k_f_std_error", &f.K_f_std_error},
                                              {"impacts_per_tau", &f.impacts_per_tau},
                                              {"mean_energy_loss", &f.mean_energy_loss},
                                              {"mean_flight_time", &f.mean_flight_time},
                                              {"largest_lyapunov", &r.largest_lyapunov},
                                              {"rest_height", &p.y0},
                                              {"amplitude", &p.H},
                                              {"frequency_ratio", &p.frequency_ratio},
                                              {"k_f_work", &f.K_f_work},
                                              {"k_f_work_std_error", &f.K_f_work_std_error}};
  double number = 0.0;
  for (const auto& field : fields) *field.second = ++number;
  Cells cells;
  write_row(p, r, cells);
  for (const auto& [name, field] : fields) EXPECT_EQ(cells.numbers[name], *field) << name;
}

}  // namespace
}  // namespace afm
