// The table of a curve as a file: the rows in order, as far as they are known without a gap.
#pragma once

#include <cstddef>
#include <fstream>
#include <map>
#include <ostream>
#include <string>

#include "grid.h"
#include "packed.h"

namespace afm {

constexpr char kCurveHeader[] =
    "eta,gamma,cutoff,k_f,k_f_std_error,impacts_per_tau,mean_energy_loss,mean_flight_time,largest_lyapunov,attractor,"
    "rest_height,amplitude,frequency_ratio,k_f_work,k_f_work_std_error";

class CurveTable {
 public:
  CurveTable(const std::string& path, const SweepGrid& grid);  // throws std::runtime_error where it cannot be written

  void add(std::size_t position, const SweepResult& result);
  void flush();  // throws std::runtime_error
  void cut();    // what an earlier run wrote beyond this
  std::size_t done() const { return rows_ + waiting_.size(); }

 private:
  void open();
  std::string path_;
  const SweepGrid& grid_;
  std::ofstream file_;
  std::ostream& out_;
  std::size_t rows_ = 0;                        // written
  std::map<std::size_t, SweepResult> waiting_;  // for rows before them
};

}  // namespace afm
