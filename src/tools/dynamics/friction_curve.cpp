// K_f against drag velocity, restitution and cutoff.
#include <cstdint>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

#include "dynamics_options.h"
#include "sweep/curve_run.h"

namespace {

const char kDescription[] =
    "Computes the friction coefficient K_f over ranges of drag velocity, restitution and cutoff (units a, tau, tip\n"
    "mass). A range is one number or FROM:TO:STEP. The table has the columns eta,gamma,cutoff,k_f,k_f_std_error,\n"
    "impacts_per_tau,mean_energy_loss,mean_flight_time,largest_lyapunov,attractor; k_f +- 1.96 k_f_std_error holds "
    "the\n"
    "true mean 95 times in 100. Beside the table lies OUTPUT.journal: interrupted and started again, the same command\n"
    "goes on where it was. Under mpirun all ranks work on one table. The numbers depend on nothing but the options "
    "that\n"
    "name them: not on threads, ranks or interruptions.";

struct Options {
  std::string eta = "0.1:9:0.1", gamma = "0.7", cutoff = "0.05", sweep = "fresh", model = "oscillator", output = "-";
  std::int64_t seed = 1;
  int threads = 0;
  afm::CurveSettings settings;
};

const std::map<std::string, afm::SweepDirection> kDirections{
    {"fresh", afm::SweepDirection::fresh}, {"up", afm::SweepDirection::up}, {"down", afm::SweepDirection::down}};

// Bad input: exit code 2.
[[noreturn]] void refuse(const std::string& what) { throw std::invalid_argument(what); }

void parse(afm::CommandLine& app, Options& o) {
  afm::SweepSettings& sweep = o.settings.sweep;
  app.option("eta", o.eta, "drag velocity [a/tau]");
  app.option("gamma", o.gamma, "restitution at and above the cutoff");
  app.option("cutoff", o.cutoff, "cutoff speed of the restitution [a/tau]");
  app.option("duration", sweep.duration, "measured at each point [tau]");
  app.option("transient", sweep.transient, "before it [tau]");
  afm::add_model_option(app, o.model);
  app.option("sweep", o.sweep,
             "fresh: each point from a random start; up, down: each from where the eta before it ended");
  app.option("threads", o.threads, "0: one for each processor; under mpirun one for each rank");
  app.option("seed", o.seed, "of the random starts");
  app.option("output", o.output, "the table; - is standard output");
}

void check(Options& o) {
  afm::CurveSettings& s = o.settings;
  s.eta = afm::range_option("eta", o.eta);
  s.gamma = afm::range_option("gamma", o.gamma);
  s.cutoff = afm::range_option("cutoff", o.cutoff);
  const auto direction = kDirections.find(o.sweep);
  if (direction == kDirections.end()) refuse("sweep = " + o.sweep + ": must be fresh, up or down");
  s.direction = direction->second;
  s.model = afm::checked_kind(o.model);
  if (o.threads < 0 || o.threads > 1024)
    refuse("threads = " + std::to_string(o.threads) + ": must be within 0 and 1024");
  if (o.seed < 0) refuse("seed = " + std::to_string(o.seed) + ": must not be negative");
  s.sweep.seed = static_cast<std::uint64_t>(o.seed);
  const std::vector<afm::ParameterError> faults = afm::find_faults(s);
  if (!faults.empty()) refuse(afm::describe(faults));
}

}  // namespace

int main(int argc, char** argv) {
  afm::CommandLine app("friction_curve", kDescription);
  Options options;
  parse(app, options);
  return app.run(argc, argv, [&] {
    check(options);
    return afm::run_curve(options.settings, options.output, options.threads);
  });
}
