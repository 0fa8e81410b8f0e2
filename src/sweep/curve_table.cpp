#include "curve_table.h"

#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <iostream>
#include <stdexcept>

namespace afm {
namespace {

using Q = Quantity;

const std::vector<Column> kColumns{{"eta", Q::velocity, "drag_velocity"},
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

void write_row(const SweepPoint& point, const SweepResult& r, TableWriter& to) {
  const FrictionAverage& f = r.friction;
  to << point.eta << point.gamma << point.v_c << f.K_f << f.K_f_std_error << f.impacts_per_tau << f.mean_energy_loss
     << f.mean_flight_time << r.attractor.lyapunov.exponents[0] << r.attractor.name() << point.y0 << point.H
     << point.frequency_ratio << f.K_f_work << f.K_f_work_std_error;
  to.end_row();
}

}  // namespace

CurveTable::CurveTable(const std::string& path, const SweepGrid& grid, const TableUnits& units)
    : path_(path), grid_(grid), out_(path == "-" ? std::cout : file_), writer_(out_, kColumns, units) {
  errno = 0;
  if (path != "-") open();
  writer_.write_header();
  flush();
}

// A table that is there is written over, never emptied: one that is empty would be taken for the beginning of a new
// run.
void CurveTable::open() {
  file_.open(path_, std::ios::binary | std::ios::in | std::ios::out);
  if (!file_.is_open()) file_.open(path_, std::ios::binary | std::ios::trunc);
}

void CurveTable::cut() {
  flush();
  const std::streamoff length = file_.is_open() ? static_cast<std::streamoff>(file_.tellp()) : -1;
  if (length >= 0) (void)!::truncate(path_.c_str(), length);  // fails for what is no file
}

void CurveTable::add(std::size_t position, const SweepResult& result) {
  waiting_[position] = result;
  for (auto next = waiting_.begin(); next != waiting_.end() && next->first == rows_; next = waiting_.erase(next)) {
    write_row(grid_.at(rows_), next->second, writer_);
    ++rows_;
  }
}

void CurveTable::flush() {
  if (out_.flush()) return;
  throw std::runtime_error("cannot write " + path_ + (errno != 0 ? std::string(": ") + std::strerror(errno) : ""));
}

}  // namespace afm
