#include <cmath>

#include "afm/tip.h"
#include "afm/units.h"
#include "chain.h"
#include "speed_accuracy.h"

namespace afm {
namespace {

Model mica(double v_c) {
  Model model;
  model.v_c = v_c;
  return model;
}

constexpr int kChaoticRuns = 100;

// After a transient, in the middle of a flight: so neither end of a run of whole tau on a periodic orbit is near an
// impact.
TipState settled(const Model& model, double eta, std::int64_t tau) {
  constexpr double kLong = 0.1;  // [tau]
  Tip tip(model, eta, FreeState{0.25, 0.0, 0.2, eta, 0.0});
  while (tip.now().tau < tau) tip.advance({tau, 0.0});
  for (;;) {
    const ModelTime begin = tip.now();
    const double flight = tip.segment_end() - begin;
    if (!tip.in_contact() && tip.last_impact().kind == ImpactKind::impact && flight > kLong) {
      tip.advance(begin + 0.5 * flight);
      return tip.tip_state();
    }
    tip.advance({2 * tau, 0.0});
  }
}

}  // namespace

FrictionScene even_scene(double eta) {
  FrictionScene scene{"kf_" + std::to_string(static_cast<int>(eta)), mica(0.1 * eta), eta, {}, 0.0, 2.0, 0.0};
  scene.K_f = even_K_f(scene.model);
  scene.start = settled(scene.model, eta, 1000);
  return scene;
}

FrictionScene long_run_scene(const std::string& name, double eta, double cutoff_share, double tau, bool chaotic) {
  FrictionScene scene{name, mica(cutoff_share * eta), eta, {}, 0.0, 0.0, 0.0};
  scene.start = settled(scene.model, eta, 1000);
  // a chaotic reference starts elsewhere on the attractor, a periodic one at the same point
  const TipState begin = chaotic ? settled(scene.model, eta, 1777) : scene.start;
  Runner runner = make_tip_runner(scene.model, eta, begin, 0.0);
  double sum = 0.0, squares = 0.0, impacts = 0.0;
  const int runs = chaotic ? kChaoticRuns : 1;
  for (int i = 0; i < runs; ++i) {
    const ChainResult r = runner(tau, eta, kAnyImpacts, kForever);
    sum += r.K_f(eta);
    squares += r.K_f(eta) * r.K_f(eta);
    impacts += static_cast<double>(r.impacts);
  }
  scene.K_f = sum / runs;
  scene.impacts_per_tau = impacts / (tau * runs);
  scene.chance = std::sqrt(std::fmax(0.0, squares / runs - scene.K_f * scene.K_f)) / scene.K_f;
  return scene;
}

std::vector<SpeedRow> measure_friction(const FrictionScene& scene, const std::vector<Contender>& contenders, double tau,
                                       double most_seconds, const Progress& progress) {
  std::vector<SpeedRow> rows;
  const auto run = [&](const std::string& method, double setting) {
    return make_runner(method, setting, scene.model, scene.eta, scene.start)(tau, scene.eta, kAnyImpacts, most_seconds);
  };
  for (const Contender& c : contenders) {
    progress(scene.name, c);
    const ChainResult before = run("exact", 0.0), r = run(c.spec->name, c.setting), ours = run("exact", 0.0);
    SpeedRow row{c, scene.name};
    row.impacts = static_cast<long long>(r.impacts);
    row.ns_per_tau = 1e9 * r.seconds / r.tau;
    row.ns = 1e9 * r.seconds / static_cast<double>(r.impacts);
    row.ratio = row.ns / (1e9 * std::fmin(before.seconds, ours.seconds) / static_cast<double>(ours.impacts));
    const double error = r.sound() ? std::abs(r.K_f(scene.eta) / scene.K_f - 1.0) : INFINITY;
    row.error_median = row.error_p99 = row.error_max = error;
    const double difference = static_cast<double>(r.impacts) - scene.impacts_per_tau * r.tau;
    row.missed = std::llround(std::fmax(0.0, -difference));
    row.phantom = std::llround(std::fmax(0.0, difference));
    rows.push_back(std::move(row));
  }
  return rows;
}

void print_pace_header(std::FILE* out) {
  std::fprintf(out, "method,setting,scene,seconds_per_second,k_f_error,chance\n");
}

void print_pace(const FrictionScene& scene, const SpeedRow& r, std::FILE* out) {
  const double tau_ns = 1e9 * Units(SiModel{}).time();
  std::fprintf(out, "%s,%g,%s,%.4g,%.3g,%.2g\n", r.contender.spec->name.c_str(), r.contender.setting, r.scene.c_str(),
               r.ns_per_tau / tau_ns, r.error_median, scene.chance);
  std::fflush(out);
}

}  // namespace afm
