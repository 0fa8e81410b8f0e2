#include "curve_run.h"

#include <sys/stat.h>

#include <algorithm>
#include <csignal>
#include <iostream>
#include <memory>
#include <stdexcept>
#include <thread>
#include <vector>

#include "common/progress_bar.h"
#include "curve_table.h"
#include "journal.h"
#include "ranks.h"
#include "task_board.h"

namespace afm {
namespace {

volatile std::sig_atomic_t interrupted = 0;

void interrupt(int) { interrupted = 1; }

enum class Output { fresh, to_go_on_with, stream };

Output kind_of(const std::string& path) {
  struct stat status {};
  if (path == "-") return Output::stream;
  if (::stat(path.c_str(), &status) != 0) return Output::fresh;
  if (!S_ISREG(status.st_mode)) return Output::stream;
  return status.st_size == 0 ? Output::fresh : Output::to_go_on_with;
}

bool exists(const std::string& path) {
  struct stat status {};
  return ::stat(path.c_str(), &status) == 0;
}

// The journal beside the table; none for a stream. Throws std::runtime_error where the output is not this run's.
std::unique_ptr<Journal> open_journal(const std::string& output, const std::string& identity) {
  const Output kind = kind_of(output);
  if (kind == Output::stream) return nullptr;
  const std::string path = output + ".journal";
  if (kind == Output::to_go_on_with && !exists(path)) {
    throw std::runtime_error("it is there already, without the journal that tells what it was made with");
  }
  return std::make_unique<Journal>(path, identity, kind == Output::fresh);
}

// In each of the ranks so many.
std::vector<std::thread> start_workers(WorkSource& source, const SweepGrid& grid, const SweepSettings& settings,
                                       int n) {
  std::vector<std::thread> workers;
  for (int i = 0; i < n; ++i) workers.emplace_back([&] { do_work(source, grid, settings); });
  return workers;
}

void join(std::vector<std::thread>& workers) {
  for (std::thread& worker : workers) worker.join();
}

// Rank 0's part: hands out tasks and writes what comes back.
class Run {
 public:
  Run(const CurveSettings& settings, const SweepGrid& grid, const std::string& output, const TableUnits& units)
      : grid_(grid), journal_(open_journal(output, identity(settings))), table_(output, grid, units) {
    if (journal_ == nullptr) return;
    for (const auto& done : journal_->found()) {
      if (done.first < grid.size()) table_.add(done.first, unpack(done.second));
    }
    table_.cut();
  }

  void finish(Ranks& ranks, const SweepSettings& settings, int threads) {
    TaskBoard board(tasks_left(grid_, journal_ ? journal_->found() : std::map<std::size_t, PackedResult>{}));
    std::vector<std::thread> workers = start_workers(board, grid_, settings, threads);
    ranks.expect(threads);
    try {
      collect(board, ranks);
    } catch (const std::exception& fault) {
      std::cerr << "\nfriction_curve: " << fault.what() << std::endl;
      ranks.abandon(1);
    }
    join(workers);
  }

 private:
  void collect(TaskBoard& board, Ranks& ranks) {
    const std::chrono::milliseconds patience(ranks.size() > 1 ? 1 : 100);
    ProgressBar bar(grid_.size(), table_.done());
    while (table_.done() < grid_.size() || ranks.asking() > 0) {
      ranks.serve(board);
      for (const SweepDone& done : board.collect(patience)) keep(done);
      table_.flush();
      bar.show(table_.done());
      if (interrupted != 0) give_up(ranks);
    }
  }

  void keep(const SweepDone& done) {
    if (journal_ != nullptr) journal_->append(done.position, pack(done.result));
    table_.add(done.position, done.result);
  }

  [[noreturn]] void give_up(Ranks& ranks) {
    table_.flush();
    std::cerr << "\nfriction_curve: interrupted with " << table_.done() << " of " << grid_.size() << " points done"
              << (journal_ ? "; the same command goes on from there" : "") << std::endl;
    ranks.abandon(130);
  }

  const SweepGrid& grid_;
  std::unique_ptr<Journal> journal_;
  CurveTable table_;
};

int help_rank_0(Ranks& ranks, const SweepGrid& grid, const SweepSettings& settings, int threads) {
  if (!ranks.agree(true)) return 2;
  const std::unique_ptr<WorkSource> board = ranks.remote_board();
  std::vector<std::thread> workers = start_workers(*board, grid, settings, threads);
  join(workers);
  return 0;
}

// 0: every processor, unless mpirun has placed a rank on each.
int thread_count(int asked, int ranks) {
  if (asked > 0) return asked;
  return ranks > 1 ? 1 : std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

}  // namespace

int run_curve(const CurveSettings& settings, const std::string& output, int threads, const TableUnits& units) {
  Ranks ranks;
  const SweepGrid grid(settings);
  const int n = thread_count(threads, ranks.size());
  if (ranks.rank() > 0) return help_rank_0(ranks, grid, settings.sweep, n);
  std::unique_ptr<Run> run;
  try {
    run = std::make_unique<Run>(settings, grid, output, units);
  } catch (const std::exception& fault) {
    std::cerr << "friction_curve: output = " << output << ": " << fault.what()
              << "\n  (choose another name, or remove it to begin again)" << std::endl;
  }
  if (!ranks.agree(run != nullptr)) return 2;
  std::signal(SIGINT, interrupt);
  std::signal(SIGTERM, interrupt);
  run->finish(ranks, settings.sweep, n);
  return 0;
}

}  // namespace afm
