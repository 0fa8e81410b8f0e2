// K_f with bursts and contact against K_f with every bounce by itself, where that can be done; CSV. What is left of
// their difference should be 1e-3 of K_f, or chance: a few standard errors of the two.
#include <cmath>
#include <cstdio>
#include <vector>

#include "afm/friction.h"
#include "afm/tip.h"
#include "common/command_line.h"

namespace {

struct Options {
  std::vector<double> eta{0.2, 0.5, 1.5, 2.75, 3.0, 3.4, 5.0, 6.25, 7.0}, cutoff{0.1, 0.03, 0.01, 0.003, 0.001};
  double gamma = 0.7, tolerance = afm::kDefaultContactTolerance;
  std::int64_t tau = 20000, transient = 500;
  double most_events = 2e8;
};

struct Result {
  bool finished;
  double events;
  afm::FrictionEstimate friction;
};

Result run(double eta, double cutoff, double tolerance, const Options& o) {
  afm::Model model;
  model.gamma = o.gamma;
  model.v_c = cutoff;
  afm::Tip tip(model, eta, afm::FreeState{0.25, 0.0, 0.2, eta, 0.0}, tolerance);
  afm::Friction friction(1000.0);
  const afm::ModelTime begin{o.transient, 0.0}, end{o.transient + o.tau, 0.0};
  Result r{true, 0.0, {}};
  afm::Segments ended;
  for (bool counting = false;;) {
    const afm::Outcome outcome = tip.advance_segment(counting ? end : begin, &ended);
    if (outcome == afm::Outcome::time_limit) {
      if (counting) break;
      friction.restart(begin, eta);
      counting = true;
    }
    if (outcome != afm::Outcome::flying && ++r.events > o.most_events) return {false, r.events, {}};
    if (!counting) continue;
    for (const afm::Segment& segment : ended) friction.add(segment);
  }
  r.friction = friction.estimate(end, tip.segment());
  return r;
}

void print_row(double eta, double cutoff, const Options& o) {
  const Result bursts = run(eta, cutoff, o.tolerance, o), bounces = run(eta, cutoff, 0.0, o);
  const afm::FrictionEstimate &a = bursts.friction, &b = bounces.friction;
  std::printf("%g,%g,%.9g,%.1e,%.3g,", eta, cutoff, a.K_f, a.K_f_std_error, bursts.events);
  if (bounces.finished) {
    const double error = std::hypot(a.K_f_std_error, b.K_f_std_error), off = a.K_f - b.K_f;
    std::printf("%.9g,%.1e,%.3g,%.1e,%.2g\n", b.K_f, b.K_f_std_error, bounces.events, off / b.K_f, off / error);
  } else {
    std::printf(",,,,\n");
  }
  std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
  Options o;
  afm::CommandLine app("burst_friction", "K_f with bursts and contact, and bounce by bounce (natural units).");
  app.option("eta", o.eta, "drag speeds [a/tau]");
  app.option("cutoff", o.cutoff, "v_c [a/tau]");
  app.option("gamma", o.gamma, "restitution");
  app.option("tolerance", o.tolerance, "contact tolerance");
  app.option("tau", o.tau, "measured time of each");
  app.option("transient", o.transient, "time before that");
  app.option("most-events", o.most_events, "a run of more is stopped");
  return app.run(argc, argv, [&] {
    std::printf("eta,v_c,k_f,std_error,events,k_f_bounces,std_error_bounces,events_bounces,relative,in_std_errors\n");
    for (const double eta : o.eta) {
      for (const double cutoff : o.cutoff) print_row(eta, cutoff, o);
    }
    return 0;
  });
}
