// How much faster than real time one tip is, over drag speeds and cutoffs, and what K_f comes out: CSV on stdout, a
// summary on stderr. A tau is 157 us with the paper's springs. In processor time; a tau that seems the slowest is made
// again, as it may have been interrupted.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <vector>

#include "afm/tip.h"
#include "afm/units.h"
#include "common/command_line.h"
#include "common/cpu_clock.h"

namespace {

using Clock = std::chrono::steady_clock;

struct Options {
  std::vector<double> eta, cutoff{0.1, 0.05, 0.01, 0.001};
  double step = 0.05, highest = 9.0, tolerance = afm::kDefaultContactTolerance;
  std::int64_t tau = 1000, transient = 200;
  afm::Bath bath;
};

struct Figures {
  double times_real_time, slowest_tau_us, K_f, impacts_per_tau;
  long search_failures;
};

double seconds_since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

struct Tau {
  double energy = 0.0, events = 0.0;
  long search_failures = 0;
};

Tau run_tau(afm::Tip& tip, std::int64_t end) {
  Tau tau;
  for (;;) {
    const afm::Outcome outcome = tip.advance({end, 0.0});
    if (outcome == afm::Outcome::time_limit) return tau;
    if (outcome == afm::Outcome::search_failed) ++tau.search_failures;
    if (outcome != afm::Outcome::impact) continue;
    tau.energy += tip.last_impact().energy_loss;
    tau.events += tip.last_impact().count;
  }
}

// The time of the same tau again, the least of some: what is left when the machine does nothing else in between.
double least_seconds(const afm::Tip& before, std::int64_t end) {
  constexpr int kAgain = 5;
  double least = INFINITY;
  for (int i = 0; i < kAgain; ++i) {
    afm::Tip tip = before;
    const auto start = Clock::now();
    run_tau(tip, end);
    least = std::min(least, seconds_since(start));
  }
  return least;
}

double slowest_tau(afm::Tip tip, const Options& o) {
  double slowest = 0.0;
  for (std::int64_t t = 1; t <= o.transient + o.tau; ++t) {
    const afm::Tip before = tip;
    const auto start = Clock::now();
    run_tau(tip, t);
    if (seconds_since(start) > slowest) slowest = std::max(slowest, least_seconds(before, t));
  }
  return slowest;
}

// Twice the same run: as a whole, and tau by tau, for which the clock is read and the tip copied in between.
Figures measure(double eta, double cutoff, const Options& o) {
  afm::Model model;
  model.v_c = cutoff;
  afm::Tip start(model, eta, afm::FreeState{0.25, 0.0, 0.2, eta, 0.0}, o.tolerance);
  start.set_bath(o.bath);
  afm::Tip tip = start;
  Figures f{0.0, 0.0, 0.0, 0.0, 0};
  Tau sum;
  const double begin = afm::thread_seconds();
  for (std::int64_t t = 1; t <= o.transient + o.tau; ++t) {
    const Tau tau = run_tau(tip, t);
    f.search_failures += tau.search_failures;
    if (t > o.transient) sum.energy += tau.energy, sum.events += tau.events;
  }
  const double total = afm::thread_seconds() - begin;
  const double tau_s = afm::Units(afm::SiModel{}).time(), taus = static_cast<double>(o.tau);
  f.times_real_time = static_cast<double>(o.transient + o.tau) * tau_s / total;
  f.slowest_tau_us = 1e6 * slowest_tau(start, o);
  f.K_f = sum.energy / (eta * eta * taus);
  f.impacts_per_tau = sum.events / taus;
  return f;
}

}  // namespace

int main(int argc, char** argv) {
  Options o;
  afm::CommandLine app(
      "real_time", "Times real time, slowest tau and K_f of one tip, over drag speeds and cutoffs (natural units).");
  app.option("eta", o.eta, "drag speeds [a/tau]; default: 0 to --highest in steps of --step");
  app.option("step", o.step, "");
  app.option("highest", o.highest, "");
  app.option("cutoff", o.cutoff, "v_c [a/tau]");
  app.option("tolerance", o.tolerance, "contact tolerance");
  app.option("temperature", o.bath.temperature, "kT of the heat bath [m a^2/tau^2]", {0.0, afm::kMaxTemperature});
  app.option("quality-factor", o.bath.quality_factor, "of the cantilever; 0: no bath", {0.0, 1e12});
  app.option("tau", o.tau, "measured time each");
  app.option("transient", o.transient, "time before that");
  return app.run(argc, argv, [&] {
    if (o.eta.empty()) {
      for (int i = 0; i * o.step <= o.highest + 1e-9; ++i) o.eta.push_back(i * o.step);
    }
    std::printf("eta,cutoff,times_real_time,slowest_tau_us,k_f,impacts_per_tau,search_failures\n");
    double worst = INFINITY, slowest = 0.0;
    std::size_t below = 0, all = 0;
    for (const double cutoff : o.cutoff) {
      for (const double eta : o.eta) {
        const Figures f = measure(eta, cutoff, o);
        std::printf("%.17g,%.17g,%.4g,%.4g,%.9g,%.6g,%ld\n", eta, cutoff, f.times_real_time, f.slowest_tau_us, f.K_f,
                    f.impacts_per_tau, f.search_failures);
        std::fflush(stdout);
        worst = std::min(worst, f.times_real_time);
        slowest = std::max(slowest, f.slowest_tau_us);
        below += f.times_real_time < 20.0 ? 1 : 0;
        ++all;
      }
    }
    std::fprintf(stderr, "%zu points, %zu below 20 times real time; slowest point %.3g times, slowest tau %.3g us\n",
                 all, below, worst, slowest);
    return 0;
  });
}
