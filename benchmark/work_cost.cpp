// Cost against work: time against impacts, tips and threads, and memory against tips. CSV; straight lines
// are expected.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <numeric>
#include <thread>
#include <vector>

#include "afm/ensemble.h"
#include "afm/tip.h"
#include "common/command_line.h"
#include "common/cpu_clock.h"
#include "quantile.h"

namespace {

using Clock = std::chrono::steady_clock;

constexpr double kEta = 3.4;

struct Options {
  long most_impacts = 10000000, most_tips = 100000, impacts_a_tip = 100, impacts_a_thread = 500000;
  int rounds = 5;
};

double wall_seconds() { return std::chrono::duration<double>(Clock::now().time_since_epoch()).count(); }

afm::Tip tip_number(long n) {
  afm::Model model;
  model.v_c = 0.1 * kEta;
  return {model, kEta, afm::FreeState{0.25, 1e-3 * static_cast<double>(n % 100), 0.2, kEta, 0.0}};
}

void fly(afm::Tip& tip, long impacts) {
  for (long i = 0; i < impacts; ++i) tip.advance(afm::kEndOfTime);
}

double median(const std::vector<double>& values) { return afm::quantile(values, 0.5); }

// The memory that this process holds now [bytes], from the kernel.
double resident_bytes() {
  long pages = 0, resident = 0;
  std::FILE* file = std::fopen("/proc/self/statm", "r");
  if (file == nullptr) return 0.0;
  const bool read = std::fscanf(file, "%ld %ld", &pages, &resident) == 2;
  std::fclose(file);
  return read ? 4096.0 * static_cast<double>(resident) : 0.0;
}

void print(const char* axis, long n, double seconds, double ns_per_impact, double bytes) {
  std::printf("%s,%ld,%.6g,%.5g,%.0f\n", axis, n, seconds, ns_per_impact, bytes);
  std::fflush(stdout);
}

void against_impacts(const Options& o) {
  for (long n = 100; n <= o.most_impacts; n *= 10) {
    std::vector<double> seconds;
    for (int round = 0; round < o.rounds; ++round) {
      afm::Tip tip = tip_number(0);
      fly(tip, 1000);  // onto the attractor
      const double start = afm::thread_seconds();
      fly(tip, n);
      seconds.push_back(afm::thread_seconds() - start);
    }
    print("impacts", n, median(seconds), 1e9 * median(seconds) / static_cast<double>(n), resident_bytes());
  }
}

// All tips a few impacts on, one tip after another.
void against_tips(const Options& o) {
  const double before = resident_bytes();
  std::vector<afm::Tip> tips;
  for (long n = 1; n <= o.most_tips; n *= 10) {
    tips.reserve(static_cast<std::size_t>(n));
    while (static_cast<long>(tips.size()) < n) tips.push_back(tip_number(static_cast<long>(tips.size())));
    std::vector<double> seconds;
    for (int round = 0; round < o.rounds; ++round) {
      const double start = afm::thread_seconds();
      for (afm::Tip& tip : tips) fly(tip, o.impacts_a_tip);
      seconds.push_back(afm::thread_seconds() - start);
    }
    const double impacts = static_cast<double>(n) * static_cast<double>(o.impacts_a_tip);
    print("tips", n, median(seconds), 1e9 * median(seconds) / impacts, resident_bytes() - before);
  }
  std::fprintf(stderr, "one tip is %zu bytes\n", sizeof(afm::Tip));
}

// The same work for each thread: wall time, which more threads than free cores must stretch, and processor time.
void against_threads(const Options& o) {
  const int most_threads = static_cast<int>(std::max(2u, 2 * std::thread::hardware_concurrency()));
  for (int threads = 1; threads <= most_threads; ++threads) {
    std::vector<double> wall, ns;
    for (int round = 0; round < o.rounds; ++round) {
      std::vector<double> used(static_cast<std::size_t>(threads));
      const double start = wall_seconds();
      std::vector<std::thread> running;
      for (int t = 0; t < threads; ++t) {
        running.emplace_back([&o, &used, t] {
          const double begin = afm::thread_seconds();
          afm::Tip tip = tip_number(t);
          fly(tip, o.impacts_a_thread);
          used[static_cast<std::size_t>(t)] = afm::thread_seconds() - begin;
        });
      }
      for (std::thread& thread : running) thread.join();
      wall.push_back(wall_seconds() - start);
      ns.push_back(std::accumulate(used.begin(), used.end(), 0.0) / threads);
    }
    // the quietest round: others on the machine only ever add
    const double best = *std::min_element(wall.begin(), wall.end());
    print("threads", threads, best, 1e9 * median(ns) / static_cast<double>(o.impacts_a_thread), resident_bytes());
  }
}

}  // namespace

int main(int argc, char** argv) {
  Options o;
  afm::CommandLine app("work_cost",
                       "Cost against work: time against impacts, tips (one after another) and threads (wall time), "
                       "memory. CSV.");
  app.option("impacts", o.most_impacts, "most impacts of one tip");
  app.option("tips", o.most_tips, "most tips");
  app.option("rounds", o.rounds, "times each is measured", afm::kPositive);
  return app.run(argc, argv, [&] {
    std::printf("axis,n,seconds,ns_per_impact,resident_bytes\n");
    against_impacts(o);
    against_tips(o);
    against_threads(o);
    return 0;
  });
}
