#include <cmath>
#include <memory>
#include <random>

#include "afm/tip.h"
#include "common/cpu_clock.h"
#include "core/search/impact_search.h"
#include "flights.h"
#include "quantile.h"
#include "stability.h"

namespace afm {
namespace {

using rivals::Hit;
using rivals::Method;
using rivals::MethodSpec;

// A flight, and where a command changes the drag velocity in its course, the part before that.
struct Case {
  Flight113 flight;
  bool commanded;
  double eta_before;
  TipState before;
  double until;
};

struct Cases {
  FlightScene scene;  // model and drag velocity; its flights are in the cases
  std::vector<Case> cases;
};

Hit run_case(const Cases& all, const Case& c, const Method& method) {
  TipState start = c.flight.start;
  if (c.commanded) {
    const Hit first = method(all.scene.model, c.eta_before, c.before, c.until);
    if (first.kind == Hit::impact) return {Hit::impact, -1.0, start, 0.0};  // before the command: none is there
    if (first.kind != Hit::none) return first;
    start = first.after;
  }
  return method(all.scene.model, all.scene.eta, start, kFlightHorizon);
}

Cell judge(const FlightScore& score, std::size_t done, std::size_t all) {
  Cell cell;
  const std::string of = " of " + std::to_string(done);
  const double worst = score.errors.empty() ? 0.0 : quantile(score.errors, 1.0);
  if (done < all) {
    cell = {Verdict::stalls, static_cast<double>(done), "flights done of " + std::to_string(all)};
  } else if (score.missed > 0 && score.missed >= score.phantom) {
    cell = {Verdict::misses, static_cast<double>(score.missed), "missed" + of};
  } else if (score.phantom > 0) {
    cell = {Verdict::phantom, static_cast<double>(score.phantom), "phantom" + of};
  } else {
    cell = {worst <= kRightError ? Verdict::right : Verdict::inaccurate, worst, "largest error"};
  }
  return cell;
}

Cell measure(const std::vector<Cases>& groups, const MethodSpec& spec, double setting, const Effort& effort) {
  const Method method = spec.make(setting);
  FlightScore score;
  std::size_t done = 0, all = 0;
  double tau = 0.0;
  const double start = thread_seconds();
  for (const Cases& group : groups) {
    all += group.cases.size();
    for (const Case& c : group.cases) {
      if (thread_seconds() - start > effort.seconds) break;
      const Hit hit = run_case(group, c, method);
      score.add(c.flight, hit, group.scene);
      tau += std::fmin(kFlightHorizon, std::fmax(0.0, hit.dt));
      ++done;
    }
  }
  Cell cell = judge(score, done, all);
  cell.ns_per_tau = 1e9 * (thread_seconds() - start) / tau;
  return cell;
}

StabilityScene scene_of(const std::string& name, const std::string& about,
                        const std::function<std::vector<Cases>()>& build) {
  const auto cache = std::make_shared<std::vector<Cases>>();
  return {name, about, [=](const MethodSpec& spec, double setting, const Effort& effort) {
            if (cache->empty()) *cache = build();
            return measure(*cache, spec, setting, effort);
          }};
}

Cases attractor(const Model& model, double eta, std::size_t count) {
  FlightScene scene = sample_attractor("", model, eta, count, 1);
  Cases all{{"", model, eta, {}}, {}};
  for (const Flight113& f : scene.flights) all.cases.push_back({f, false, eta, f.start, 0.0});
  return all;
}

// Runs time backwards from an impact of the given normal speed to the impact before.
bool graze(double normal_speed, std::mt19937_64& random, Cases& all) {
  const auto within = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  const Model& model = all.scene.model;
  const double eta = all.scene.eta, phase = within(-0.2, 0.2);
  const double slope = surface_jet(model.H, phase).h1;
  const TipState touch{phase, within(-0.03, 0.03), -eta * within(0.7, 1.3), 0.0,
                       normal_speed * std::sqrt(1.0 + slope * slope)};
  const Flight<Quad> back(SpringConstants<Quad>(model), Quad(-eta), touch);
  if (!(back.start().g2 > 1)) return false;
  const Landing<Quad> before = detail::find_impact(back, Quad(kFlightHorizon));
  if (before.outcome != SearchOutcome::impact || before.jet.g1 > -1e-2) return false;
  const FlightState<Quad>& q = before.jet.state;
  const TipState start{wrap_phase(static_cast<double>(q.phase)), static_cast<double>(q.X),
                       -static_cast<double>(q.U - eta), 0.0, -static_cast<double>(before.jet.g1)};
  if (!add_flight(all.scene, start)) return false;
  all.cases.push_back({all.scene.flights.back(), false, eta, start, 0.0});
  return true;
}

std::vector<Cases> grazes(double share, std::size_t count) {
  Cases all{{"", Model{}, 3.4, {}}, {}};
  std::mt19937_64 random(1);
  while (all.cases.size() < count) graze(share * all.scene.eta, random, all);
  return {all};
}

// In the middle of flights at eta = 3.4 the drag velocity becomes another.
Cases commands(double eta_after, std::size_t count) {
  const Model model;
  const double eta = 3.4;
  const FlightScene from = sample_attractor("", model, eta, count, 2);
  Cases all{{"", model, eta_after, {}}, {}};
  std::mt19937_64 random(3);
  for (const Flight113& f : from.flights) {
    const double until = std::uniform_real_distribution<double>(0.05, 0.95)(random) * static_cast<double>(f.truth.dt);
    const Flight<Quad> flight(SpringConstants<Quad>(model), Quad(eta), f.start);
    if (!add_flight(all.scene, flight.tip_state(Quad(until)))) continue;
    all.cases.push_back({all.scene.flights.back(), true, eta, f.start, until});
  }
  return all;
}

Model crest(double share) {
  Model model;
  model.y0 = share * model.H;
  return model;
}

Model steep() {
  Model model;
  model.H *= 10.0;
  model.v_c = 0.34;
  return model;
}

Model fast() {
  Model model;
  model.v_c = 5.0;
  return model;
}

}  // namespace

std::vector<StabilityScene> flight_scenes(const Effort& effort) {
  const std::size_t n = effort.quick ? 40 : 400;
  std::vector<StabilityScene> scenes;
  for (const int decade : {3, 4, 6, 8, 10, 12}) {
    const double share = std::pow(10.0, -decade);
    scenes.push_back(scene_of("graze_1e-" + std::to_string(decade),
                              "grazing impacts at a normal speed of 1e-" + std::to_string(decade) + " v0",
                              [=] { return grazes(share, n / 4); }));
  }
  scenes.push_back(scene_of("commands", "the drag velocity changes in mid-flight, from 3.4 to 7, 0 and -2", [=] {
    return std::vector<Cases>{commands(7.0, n / 4), commands(0.0, n / 4), commands(-2.0, n / 4)};
  }));
  scenes.push_back(scene_of("eta_50", "eta = 50", [=] { return std::vector<Cases>{attractor(fast(), 50.0, n)}; }));
  scenes.push_back(scene_of("crest_0.9", "holder at 0.9 of the crest's height",
                            [=] { return std::vector<Cases>{attractor(crest(0.9), 3.4, n)}; }));
  scenes.push_back(scene_of("crest_0.999", "holder at 0.999 of the crest's height",
                            [=] { return std::vector<Cases>{attractor(crest(0.999), 3.4, n)}; }));
  scenes.push_back(
      scene_of("steep", "a surface ten times steeper", [=] { return std::vector<Cases>{attractor(steep(), 3.4, n)}; }));
  return scenes;
}

}  // namespace afm
