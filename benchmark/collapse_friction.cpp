// K_f of a heated tip under load, by both estimators: at a contact tolerance, at which the bounces after a kick are one
// event, and at a reference tolerance, at which nearly all of them are made; CSV.
#include <cstdio>
#include <vector>

#include "afm/friction.h"
#include "afm/tip.h"
#include "common/command_line.h"

namespace {

struct Options {
  std::vector<double> frequency_ratio{6.25, 21.0}, rest_height{-0.3, -1.0, -3.0, -10.0}, eta{0.3, 1.5};
  double temperature = 0.926, quality_factor = 100.0, cutoff = 0.05, tolerance = afm::kDefaultContactTolerance;
  double reference = 1e-6;
  std::int64_t tau = 3000, transient = 100;
};

afm::FrictionEstimate run(const afm::Model& model, double eta, double tolerance, const Options& o) {
  afm::Tip tip(model, eta, afm::FreeState{0.25, 0.0, 0.2, eta, 0.0}, tolerance);
  afm::Bath bath;
  bath.temperature = o.temperature;
  bath.quality_factor = o.quality_factor;
  tip.set_bath(bath);
  const afm::ModelTime begin{o.transient, 0.0}, end{o.transient + o.tau, 0.0};
  while (tip.advance(begin) != afm::Outcome::time_limit) continue;
  afm::Friction friction(1000.0);
  friction.restart(begin, eta);
  afm::Segments ended;
  while (tip.advance_segment(end, &ended) != afm::Outcome::time_limit) {
    for (const afm::Segment& segment : ended) friction.add(segment);
  }
  return friction.estimate(end, tip.segment());
}

void print_row(const afm::Model& model, double eta, const Options& o) {
  const afm::FrictionEstimate a = run(model, eta, o.tolerance, o), b = run(model, eta, o.reference, o);
  std::printf("%g,%g,%g,%.4g,%.4g,%.2g,%.4g,%.4g,%.2g\n", model.frequency_ratio, model.y0, eta, a.K_f_work, b.K_f_work,
              b.K_f_work_std_error, a.K_f, b.K_f, b.K_f_std_error);
  std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
  Options o;
  afm::CommandLine app("collapse_friction",
                       "K_f of a heated tip under load at two contact tolerances (natural units).");
  app.option("eta", o.eta, "drag speeds [a/tau]");
  app.option("frequency-ratio", o.frequency_ratio, "omega_h/omega_v");
  app.option("rest-height", o.rest_height, "height of the holder [a]; below 0: load");
  app.option("temperature", o.temperature, "theta [m a^2/tau^2]");
  app.option("quality-factor", o.quality_factor, "Q of both springs");
  app.option("cutoff", o.cutoff, "v_c [a/tau]");
  app.option("tolerance", o.tolerance, "contact tolerance");
  app.option("reference", o.reference, "the other contact tolerance");
  app.option("tau", o.tau, "measured time of each");
  app.option("transient", o.transient, "time before that");
  return app.run(argc, argv, [&] {
    std::printf(
        "omega_h/omega_v,rest height,eta,K_f by work,its reference,its std. error,"
        "K_f by impacts,the reference,the std. error\n");
    for (const double ratio : o.frequency_ratio) {
      for (const double height : o.rest_height) {
        for (const double eta : o.eta) {
          afm::Model model;
          model.frequency_ratio = ratio;
          model.y0 = height;
          model.v_c = o.cutoff;
          print_row(model, eta, o);
        }
      }
    }
    return 0;
  });
}
