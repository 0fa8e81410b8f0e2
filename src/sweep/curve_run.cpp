#include "curve_run.h"

#include <atomic>
#include <csignal>
#include <cstdint>
#include <cstdlib>
#include <exception>
#include <iostream>
#include <memory>
#include <vector>

#include "common/in_order.h"
#include "common/progress_bar.h"
#include "curve_file.h"

namespace afm {
namespace {

volatile std::sig_atomic_t interrupted = 0;

void interrupt(int) { interrupted = 1; }

// Ends the process at once, without waiting for the threads: a point may take minutes.
[[noreturn]] void end_interrupted(const CurveFile& table, const CurveSettings& settings) {
  std::cerr << "\nfriction_curve: interrupted with " << table.rows() << " of " << settings.size() << " points done";
  if (table.can_go_on()) {
    std::cerr << "; the same command goes on from "
              << (settings.chain_length() > 1 ? "the last whole sweep of eta" : "there");
  }
  std::cerr << std::endl;
  std::_Exit(130);
}

}  // namespace

int run_curve(const CurveSettings& settings, const std::string& output, int threads, const TableUnits& units) {
  std::unique_ptr<CurveFile> table;
  try {
    table = std::make_unique<CurveFile>(output, settings, units);
  } catch (const std::exception& fault) {
    std::cerr << "friction_curve: output = " << output << ": " << fault.what() << std::endl;
    return output == "-" ? 1 : 2;
  }
  std::signal(SIGINT, interrupt);
  std::signal(SIGTERM, interrupt);
  const std::size_t length = settings.chain_length(), first = table->rows() / length;
  std::atomic<std::size_t> done{table->rows()};
  std::uint64_t failures = 0;
  ProgressBar bar(settings.size(), done);
  const auto watch = [&] {
    bar.show(done);
    if (interrupted != 0) end_interrupted(*table, settings);
  };
  const auto compute = [&](std::size_t i) { return compute_chain(settings, (first + i) * length, done); };
  const auto take = [&](std::size_t, const std::vector<SweepResult>& chain) {
    try {
      for (const SweepResult& result : chain) {
        table->add(result);
        failures += result.friction.search_failures;
      }
      table->flush();
    } catch (const std::exception& fault) {
      std::cerr << "\nfriction_curve: " << fault.what() << std::endl;
      std::_Exit(1);
    }
    watch();
  };
  in_order(settings.size() / length - first, static_cast<std::size_t>(threads), compute, take, watch);
  if (failures > 0)
    std::cerr << "friction_curve: warning: " << failures << " failed searches of an impact" << std::endl;
  return 0;
}

}  // namespace afm
