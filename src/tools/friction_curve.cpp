// K_f against drag velocity, restitution and cutoff.
#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

#ifdef AFM_DYNAMICS
#include "afm/dynamics/sweep.h"
#endif
#include "common/lever_options.h"
#include "common/point_options.h"
#include "common/si_options.h"
#include "sweep/curve_run.h"

namespace {

const char kDescription[] =
    "Computes the friction coefficient K_f over ranges of drag velocity, restitution, cutoff, load and surface (units\n"
    "a, tau, tip mass m). VALUES are numbers or ranges FROM:TO:STEP. The table has the columns eta,gamma,\n"
    "cutoff,k_f,k_f_std_error,impacts_per_tau,mean_energy_loss,mean_flight_time,largest_lyapunov,attractor,\n"
    "rest_height,amplitude,frequency_ratio,k_f_work,k_f_work_std_error. k_f comes from the energy lost in impacts\n"
    "(the paper's estimator), k_f_work from the work of the drag (the definition; with a heat bath only this is\n"
    "friction). The true mean is within 1.96 k_f_std_error 95 times in 100, and so for k_f_work, whose error is too\n"
    "large where a bath heats a slow tip; docs/friction.md says where one run knows too little of its error. Bounces\n"
    "are counted down to the threshold of the contact tolerance, or to the next kick of the bath. The holder must\n"
    "pass ten lattice spacings, or a warning says so. Beside the table lies OUTPUT.settings: interrupted and started\n"
    "again, the same command goes on where it was; with --sweep up or down it repeats the sweep of eta that was not\n"
    "finished.\n"
    "The numbers depend on nothing but the options that name them: not on threads or interruptions.";

struct Options {
  std::string sweep = "fresh", model = "oscillator", output = "-";
  std::vector<double> drag_velocity;
  std::uint64_t seed = 1;
  int threads = 0;
  afm::CurveSettings settings;
  afm::SiOptions si;
  afm::LeverOptions lever;
};

// Bad input: exit code 2.
[[noreturn]] void refuse(const std::string& what) { throw std::invalid_argument(what); }

void parse(afm::CommandLine& app, Options& o) {
  afm::CurveSettings& s = o.settings;
  afm::SweepSettings& sweep = s.sweep;
  app.ranges("eta", s.eta, "0.1:9:0.1", "drag velocity [a/tau]");
  app.ranges("gamma", s.gamma, "0.7", "restitution at and above the cutoff");
  app.ranges("cutoff", s.cutoff, "0.05", "cutoff speed of the restitution [a/tau]");
  app.ranges("rest-height", s.rest_height, "0",
             "height of the holder above mid-surface [a]; the load is -(2 pi)^2 of it");
  app.ranges("amplitude", s.amplitude, "", "of the surface [a]; mica: 0.05/0.52");
  app.ranges("frequency-ratio", s.frequency_ratio, "", "omega_h / omega_v; mica: 6.25");
  app.option("temperature", sweep.bath.temperature, "kT of the heat bath [m_tip a^2/tau^2]; at 300 K 0.926");
  app.option("quality-factor", sweep.bath.quality_factor, "of the cantilever; 0: neither damped nor heated");
  app.option("lateral-quality-factor", sweep.bath.lateral_quality_factor,
             "of the horizontal spring; 0: as the vertical");
  app.option("kicks-per-tau", sweep.bath.kicks_per_tau, "of the heat bath");
  app.option("duration", sweep.duration, "measured at each point [tau]; with --si in s");
  app.option("transient", sweep.transient, "before it [tau]; with --si in s");
  afm::add_model_option(app, o.model);
  app.option("sweep", o.sweep,
             "fresh: each point from a random start; up, down: each from where the eta before it ended");
  app.option("threads", o.threads, "0: one for each processor");
  app.option("seed", o.seed, "of the random starts and of the heat bath");
  app.option("output", o.output, "the table; - is standard output");
  app.ranges("drag-velocity", o.drag_velocity, "", afm::kDragVelocityHelp);
  afm::add_si_options(app, o.si);
  afm::add_lever_options(app, o.lever);
}

void take_lever(const afm::CommandLine& app, Options& o) {
  const auto lever = afm::take_lever(app, o.lever, o.si);
  if (!lever) return;
  afm::CurveSettings& s = o.settings;
  lever->take(app, "cutoff", s.cutoff);
  lever->take(app, "rest-height", s.rest_height);
  lever->take(app, "amplitude", s.amplitude);
  lever->take(app, "frequency-ratio", s.frequency_ratio);
  lever->take(app, "quality-factor", s.sweep.bath.quality_factor);
  lever->take(app, "lateral-quality-factor", s.sweep.bath.lateral_quality_factor);
  lever->take(app, "kicks-per-tau", s.sweep.bath.kicks_per_tau);
}

void take_si(const afm::CommandLine& app, Options& o) {
  afm::CurveSettings& s = o.settings;
  const auto take = [&](const char* name, auto& value) { afm::take_si(app, o.si, name, value); };
  take("drag-velocity", s.eta);
  take("cutoff", s.cutoff);
  take("rest-height", s.rest_height);
  take("amplitude", s.amplitude);
  take("temperature", s.sweep.bath.temperature);
  take("duration", s.sweep.duration);
  take("transient", s.sweep.transient);
}

void check(const afm::CommandLine& app, Options& o) {
  afm::CurveSettings& s = o.settings;
  if (afm::has_drag_velocity(app, o.si)) s.eta = o.drag_velocity;
  take_lever(app, o);
  afm::checked_units(app, o.si);
  take_si(app, o);
  if (!afm::parse(o.sweep, s.direction)) refuse("sweep = " + o.sweep + ": must be fresh, up or down");
  s.model = afm::checked_kind(o.model);
#ifdef AFM_DYNAMICS  // otherwise the columns attractor and largest_lyapunov say that they are not known
  s.method = afm::sweep_attractor;
#endif
  if (o.threads < 0 || o.threads > 1024)
    refuse("threads = " + std::to_string(o.threads) + ": must be within 0 and 1024");
  s.sweep.seed = s.sweep.bath.seed = o.seed;
  const std::vector<afm::ParameterError> faults = afm::as_given(app, o.si, afm::find_faults(s));
  if (!faults.empty()) refuse(afm::describe(faults));
  for (const afm::ParameterError& warning : afm::as_given(app, o.si, afm::find_warnings(s))) app.warn(warning.what());
}

}  // namespace

int main(int argc, char** argv) {
  afm::CommandLine app("friction_curve", kDescription);
  Options options;
  parse(app, options);
  return app.run(argc, argv, [&] {
    check(app, options);
    return afm::run_curve(options.settings, options.output, options.threads, afm::table_units(options.si));
  });
}
