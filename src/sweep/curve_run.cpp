#include "curve_run.h"

#include <algorithm>
#include <csignal>
#include <cstdlib>
#include <iostream>
#include <memory>
#include <stdexcept>
#include <thread>
#include <vector>

#include "common/progress_bar.h"
#include "curve_file.h"
#include "curve_points.h"

namespace afm {
namespace {

volatile std::sig_atomic_t interrupted = 0;

void interrupt(int) { interrupted = 1; }

// Ends the process at once, without waiting for the threads: a point may take minutes.
[[noreturn]] void end_interrupted(const CurveFile& table, const SweepGrid& grid) {
  std::cerr << "\nfriction_curve: interrupted with " << table.rows() << " of " << grid.size() << " points done";
  if (table.can_go_on()) {
    std::cerr << "; the same command goes on from "
              << (grid.chain_length() > 1 ? "the last whole sweep of eta" : "there");
  }
  std::cerr << std::endl;
  std::_Exit(130);
}

void write_all(CurvePoints& points, const SweepGrid& grid, CurveFile& table) {
  constexpr std::chrono::milliseconds kPatience(100);  // to answer Ctrl-C
  ProgressBar bar(grid.size(), table.rows());
  while (table.rows() < grid.size()) {
    for (const SweepResult& result : points.collect(kPatience)) table.add(result);
    table.flush();
    bar.show(table.rows());
    if (interrupted != 0) end_interrupted(table, grid);
  }
}

}  // namespace

int run_curve(const CurveSettings& settings, const std::string& output, int threads, const TableUnits& units) {
  const SweepGrid grid(settings);
  std::unique_ptr<CurveFile> table;
  try {
    table = std::make_unique<CurveFile>(output, settings, grid, units);
  } catch (const std::exception& fault) {
    std::cerr << "friction_curve: output = " << output << ": " << fault.what() << std::endl;
    if (output == "-") return 1;
    std::cerr << "  (choose another name, or remove it to begin again)" << std::endl;
    return 2;
  }
  std::signal(SIGINT, interrupt);
  std::signal(SIGTERM, interrupt);
  CurvePoints points(grid, settings, table->rows());
  std::vector<std::thread> workers;
  const int n = threads > 0 ? threads : std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  for (int i = 0; i < n; ++i) workers.emplace_back([&] { points.work(); });
  try {
    write_all(points, grid, *table);
  } catch (const std::exception& fault) {
    std::cerr << "\nfriction_curve: " << fault.what() << std::endl;
    std::_Exit(1);
  }
  for (std::thread& worker : workers) worker.join();
  return 0;
}

}  // namespace afm
