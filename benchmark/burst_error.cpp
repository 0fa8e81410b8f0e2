// The error of bursts in the state at the next impact, against the bounces one by one: a table, a row for each
// restitution, cutoff and drag speed. Times in tau, lengths in lattice spacings.
#include <cstdio>
#include <optional>
#include <vector>

#include "common/command_line.h"
#include "quantile.h"
#include "trials/burst_trials.h"

namespace {

struct Options {
  std::vector<double> eta, cutoff, gamma;
  double rest_height = 0.0;
  std::size_t bursts = 1000;
  std::int64_t most_bounces = 100000;
};

void print_row(double gamma, double cutoff, double eta, const Options& o) {
  afm::Model model;
  model.gamma = gamma;
  model.v_c = cutoff;
  model.y0 = o.rest_height;
  afm::BurstTrials trials(model, eta, afm::kDefaultContactTolerance, 1, o.most_bounces);
  std::vector<double> worst;
  double bounces = 0.0;
  const long most_skipped = 2 * static_cast<long>(o.bursts);  // then the row has fewer
  long skipped = 0;
  while (worst.size() < o.bursts && skipped <= most_skipped) {
    std::optional<afm::BurstTrial> t = trials.next();
    while (!t && ++skipped <= 2 * most_skipped) t = trials.next();
    if (!t) break;
    worst.push_back(t->worst());
    bounces += t->bounces;
  }
  if (worst.empty()) return;
  std::printf("%g,%g,%g,%zu,%.0f,%ld,%.2g,%.2g,%.2g\n", gamma, cutoff, eta, worst.size(), bounces, skipped,
              afm::quantile(worst, 0.5), afm::quantile(worst, 0.99), afm::quantile(worst, 1.0));
  std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
  Options o;
  afm::CommandLine app("burst_error", "Error of bursts against bounces one by one (natural units).");
  app.ranges("eta", o.eta, "0.05,0.2,0.5,3,5,7,9", "drag speeds [a/tau]");
  app.ranges("cutoff", o.cutoff, "0,0.01,0.05,0.1", "v_c [a/tau]");
  app.ranges("gamma", o.gamma, "0.7", "restitution");
  app.option("rest-height", o.rest_height, "of the holder above mid-surface [a]");
  app.option("bursts", o.bursts, "how many of each");
  app.option("most-bounces", o.most_bounces, "a burst of more is skipped, and counted as skipped");
  return app.run(argc, argv, [&] {
    std::printf("gamma,v_c,eta,bursts,bounces,skipped,median,99_percent,max\n");
    for (const double gamma : o.gamma) {
      for (const double cutoff : o.cutoff) {
        for (const double eta : o.eta) print_row(gamma, cutoff, eta, o);
      }
    }
    return 0;
  });
}
