#include <algorithm>
#include <cmath>
#include <map>

#include "afm/tip.h"
#include "afm/units.h"
#include "chain.h"
#include "stability.h"
#include "trials/energy_balance.h"

namespace afm {
namespace {

using rivals::MethodSpec;

Model mica(double gamma, double v_c) {
  Model model;
  model.gamma = gamma;
  model.v_c = v_c;
  return model;
}

// A tip after a transient, in mid-flight.
TipState settled(const Model& model, double eta, std::int64_t tau) {
  Tip tip(model, eta, FreeState{0.25, 0.0, 0.2, eta, 0.0});
  while (tip.now().tau < tau) tip.advance({tau, 0.0});
  while (tip.in_contact() || !(tip.tip_state().g > 1e-3)) tip.advance(tip.now() + 0.01);
  return tip.tip_state();
}

// Whatever keeps a run from being judged by its number.
bool broken(const ChainResult& r, double tau, Cell& cell) {
  cell.ns_per_tau = 1e9 * r.seconds / r.tau;
  if (r.diverged) {
    cell = {Verdict::blows_up, r.tau, "tau before it leaves all bounds", cell.ns_per_tau};
  } else if (!r.sound() || r.tau < 0.5 * tau) {
    cell = {Verdict::stalls, r.tau, "tau of " + std::to_string(static_cast<long>(tau)), cell.ns_per_tau};
  } else {
    return false;
  }
  return true;
}

Cell judged(const ChainResult& r, double number, const std::string& meaning, double right_below = kRightError) {
  return {number <= right_below ? Verdict::right : Verdict::inaccurate, number, meaning, 1e9 * r.seconds / r.tau};
}

struct FrictionCase {
  Model model;
  double eta, K_f, tolerance, tau;
  TipState start;
};

Cell measure_friction(const FrictionCase& c, const MethodSpec& spec, double setting, const Effort& effort) {
  const ChainResult r =
      make_runner(spec.name, setting, c.model, c.eta, c.start)(c.tau, c.eta, kAnyImpacts, effort.seconds);
  Cell cell;
  if (broken(r, c.tau, cell)) return cell;
  return judged(r, std::abs(r.K_f(c.eta) / c.K_f - 1.0), "error of K_f", c.tolerance);
}

// Each of the four; the worst counts.
Cell measure_even(const MethodSpec& spec, double setting, const Effort& effort) {
  Cell worst;
  for (const double eta : {2.0, 4.0, 6.0, 8.0}) {
    const Model model = mica(0.7, 0.1 * eta);
    const FrictionCase c{
        model, eta, even_K_f(model), kRightFriction, effort.quick ? 20.0 : 100.0, settled(model, eta, 1000)};
    const Cell cell = measure_friction(c, spec, setting, effort);
    const bool worse = cell.verdict > worst.verdict || (cell.verdict == worst.verdict && !(cell.number < worst.number));
    if (worse) worst = cell;
  }
  return worst;
}

// What K_f is held against: our own long run with a cutoff and a contact tolerance at which it is sure. Tolerance 0 is
// every bounce by itself, where that can be done.
struct Reference {
  double share;  // the cutoff over eta
  double tolerance;
  bool chaotic;
};

double reference_K_f(double gamma, double eta, const Reference& reference, double tau) {
  static std::map<std::array<double, 5>, double> known;
  const std::array<double, 5> key{gamma, eta, reference.share, reference.tolerance, tau};
  const auto found = known.find(key);
  if (found != known.end()) return found->second;
  const Model model = mica(gamma, reference.share * eta);
  return known[key] =
             make_tip_runner(model, eta, settled(model, eta, 777), reference.tolerance)(tau, eta, kAnyImpacts, kForever)
                 .K_f(eta);
}

StabilityScene friction_scene(const std::string& name, const std::string& about, double gamma, double eta, double share,
                              const Reference& reference) {
  return {
      name, about,
      [=](const MethodSpec& spec, double setting, const Effort& effort) {
        const Model model = mica(gamma, share * eta);
        const bool chaotic = reference.chaotic;
        // ours goes on for longer where the error is one of statistics: it can
        const double chaotic_tau =
            (effort.quick ? 400.0 : 1000.0) * (spec.name == "exact" && setting > 0.0 ? 10.0 : 1.0);
        const double tau = chaotic ? chaotic_tau : effort.quick ? 20.0 : 100.0;
        const double K_f = reference_K_f(gamma, eta, reference, !chaotic ? 100.0 : effort.quick ? 2000.0 : 20000.0);
        const double tolerance = chaotic ? kRightStatistics : kRightFriction;
        return measure_friction({model, eta, K_f, tolerance, tau, settled(model, eta, 1000)}, spec, setting, effort);
      },
      nullptr, reference.chaotic ? kRightStatistics : kRightFriction};
}

double energy(const Model& m, const TipState& s) { return stored_energy(m, to_free_state(m.H, s)); }

TipState launched(const Model& m, double phase) { return to_tip_state(m.H, {phase, 0.0, 0.5, 0.6, 0.0}); }

// The drag stands still, near a crest, which presses for ever: what the tip loses is what the impacts took, down to
// rest.
Cell measure_rest(const MethodSpec& spec, double setting, const Effort& effort) {
  const Model model;
  const TipState start = launched(model, 0.05);
  const double tau = effort.quick ? 20.0 : 100.0, before = energy(model, start);
  const ChainResult r = make_runner(spec.name, setting, model, 0.0, start)(tau, 0.0, kAnyImpacts, effort.seconds);
  Cell cell;
  if (broken(r, tau, cell) || !r.finished) return cell.verdict = std::max(cell.verdict, Verdict::stalls), cell;
  return judged(r, std::abs(before - r.energy - energy(model, r.end)) / before, "imbalance of energy");
}

Cell measure_elastic(const MethodSpec& spec, double setting, const Effort& effort) {
  const Model model = mica(1.0, 0.05);
  const TipState start = launched(model, 0.25);
  const std::uint64_t impacts = effort.quick ? 10000 : 100000;
  const ChainResult r = make_runner(spec.name, setting, model, 0.0, start)(1e7, 0.0, impacts, 10.0 * effort.seconds);
  Cell cell;
  if (!r.sound()) return broken(r, 1e7, cell), cell;
  return judged(r, std::abs(energy(model, r.end) / energy(model, start) - 1.0),
                "drift of energy in " + std::to_string(r.impacts) + " impacts");
}

double distance(const TipState& a, const TipState& b) {
  const double turn = a.phase - b.phase;
  return std::max({std::abs(turn - std::round(turn)), std::abs(a.X - b.X), std::abs(a.u - b.u), std::abs(a.g - b.g),
                   std::abs(a.g1 - b.g1)});
}

// x = v0 t, y = h(x) solves the equations of flight and lies on the surface: whole tau lead back to the start.
Cell measure_glide(const MethodSpec& spec, double setting, const Effort& effort) {
  const Model model;
  const TipState start{0.1, 0.0, 1.0, 0.0, 0.0};
  const double tau = effort.quick ? 20.0 : 100.0;
  const ChainResult r = make_runner(spec.name, setting, model, 1.0, start)(tau, 1.0, kAnyImpacts, effort.seconds);
  Cell cell;
  if (broken(r, tau, cell)) return cell;
  return judged(r, distance(r.end, start), "off the glide");
}

// The periodic orbit at eta = 2 returns after every tau, for an hour of the tip's time, and no slower than that.
Cell measure_hour(const MethodSpec& spec, double setting, const Effort& effort) {
  const Model model = mica(0.7, 0.2);
  const TipState start = settled(model, 2.0, 2000);
  const double tau_s = Units(SiModel{}).time(), hour = std::floor(3600.0 / tau_s);
  const double target = effort.quick ? 20000.0 : hour;
  const ChainResult r =
      make_runner(spec.name, setting, model, 2.0, start)(target, 2.0, kAnyImpacts, 10.0 * effort.seconds);
  const double ns_per_tau = 1e9 * r.seconds / r.tau;
  if (!r.sound() || ns_per_tau > 1e9 * tau_s) {
    return {r.diverged ? Verdict::blows_up : Verdict::stalls, ns_per_tau * 1e-9 / tau_s,
            "times as long as the tip itself takes", ns_per_tau};
  }
  // where the seconds were over before the hour: on to a whole tau first
  const double rest = std::ceil(r.tau) - r.tau;
  const TipState end =
      rest > 0.0 ? make_runner(spec.name, setting, model, 2.0, r.end)(rest, 2.0, kAnyImpacts, effort.seconds).end
                 : r.end;
  return judged(r, distance(end, start), "off the orbit after " + std::to_string(static_cast<long>(r.tau)) + " tau");
}

double large_step(const MethodSpec& spec) {
  static const std::map<std::string, double> large{{"exact", kMaxContactTolerance},
                                                   {"certified_plain", 0.0},
                                                   {"sampled_toms748", 0.1},
                                                   {"sampled_minima", 0.1},
                                                   {"rk4", 0.05},
                                                   {"moreau_jean", 0.01},
                                                   {"semi_implicit_euler", 0.05},
                                                   {"penalty", 0.01}};
  const auto found = large.find(spec.name);
  return found == large.end() ? 1e-2 : found->second;  // the others have a tolerance
}

}  // namespace

double usual_setting(const MethodSpec& method) {
  return method.name == "exact" ? kDefaultContactTolerance : method.usual;
}

std::vector<StabilityScene> run_scenes() {
  std::vector<StabilityScene> scenes{
      {"even", "eta = 2, 4, 6, 8: K_f in closed form", measure_even, nullptr, kRightFriction},
      {"glide", "eta = 1: gliding on the surface without a reaction", measure_glide}};
  const auto add = [&scenes](const std::string& name, double gamma, double eta, double share,
                             const Reference& reference) {
    char about[80];
    std::snprintf(about, sizeof about, "eta = %g, gamma = %g, v_c = %g eta", eta, gamma, share);
    scenes.push_back(friction_scene(name, about, gamma, eta, share, reference));
  };
  // below 0.03 eta the cutoff no longer matters at eta = 3
  add("splash_3_0.1", 0.7, 3.0, 0.1, {0.1, 0.0, true});
  add("splash_3_0.03", 0.7, 3.0, 0.03, {0.03, 0.0, false});
  add("splash_3_0.01", 0.7, 3.0, 0.01, {0.01, 0.0, false});
  add("splash_3_0.003", 0.7, 3.0, 0.003, {0.01, 0.0, false});
  add("splash_3_0.001", 0.7, 3.0, 0.001, {0.01, 0.0, false});
  add("splash_5_0.1", 0.7, 5.0, 0.1, {0.1, 0.0, true});
  add("splash_5_0.01", 0.7, 5.0, 0.01, {0.1, 0.0, true});
  add("splash_5_0.001", 0.7, 5.0, 0.001, {0.1, 0.0, true});
  add("eta_0.5", 0.7, 0.5, 0.1, {0.1, 0.0, true});
  add("eta_0.2", 0.7, 0.2, 0.1, {0.1, 1e-6, false});
  scenes.push_back({"rest", "v0 = 0: down to rest", measure_rest});
  add("gamma_0.1", 0.1, 3.4, 0.01, {0.01, 0.0, false});
  add("gamma_0.01", 0.01, 3.4, 0.01, {0.1, 0.0, false});
  add("gamma_0", 0.0, 3.4, 0.01, {0.1, 0.0, false});
  scenes.push_back({"gamma_1", "gamma = 1, v0 = 0: no energy may be lost or won", measure_elastic});
  scenes.push_back({"hour", "an hour of the tip's time at eta = 2, on its orbit and in real time", measure_hour});
  StabilityScene large =
      friction_scene("large_steps", "eta = 7.5 with a coarse step or tolerance", 0.7, 7.5, 0.1, {0.1, 0.0, true});
  large.setting = large_step;
  scenes.push_back(large);
  return scenes;
}

}  // namespace afm
