#include "flights.h"

#include <algorithm>
#include <random>

#include "afm/tip.h"

namespace afm {
namespace {

constexpr std::int64_t kTransient = 200, kSpan = 100;  // [tau]
constexpr std::int64_t kMostImpacts = 2000000;

// On the attractor, and from there on every bounce by itself.
Tip settled_tip(const Model& model, double eta) {
  Tip tip(model, eta, FreeState{0.25, 0.0, std::max(0.2, 2.0 * model.H), eta, 0.0});
  while (tip.advance({kTransient, 0.0}) != Outcome::time_limit) continue;
  return {model, eta, tip.tip_state(), 0.0};
}

std::vector<TipState> impacts_of(Tip tip) {
  std::vector<TipState> starts;
  for (std::int64_t n = 0; n < kMostImpacts && tip.now().tau < kSpan; ++n) {
    if (tip.advance({kSpan, 0.0}) == Outcome::impact) starts.push_back(tip.tip_state());
  }
  return starts;
}

}  // namespace

bool add_flight(FlightScene& scene, const TipState& start) {
  const TrueImpact truth = next_impact_in_quad(scene.model, scene.eta, start, kFlightHorizon);
  if (!truth.impact) return false;
  const Flight<double> next(SpringConstants<double>(scene.model), scene.eta, truth.after);
  const Landing<double> landing = find_landing(scene.model, next, kFlightHorizon);
  if (landing.outcome != SearchOutcome::impact && landing.outcome != SearchOutcome::clear) return false;
  scene.flights.push_back({start, truth, landing.s});
  return true;
}

FlightScene sample_attractor(const std::string& name, const Model& model, double eta, std::size_t count,
                             unsigned seed) {
  FlightScene scene{name, model, eta, {}};
  std::vector<TipState> starts = impacts_of(settled_tip(model, eta));
  std::shuffle(starts.begin(), starts.end(), std::mt19937_64(seed));
  for (std::size_t i = 0; i < starts.size() && scene.flights.size() < count; ++i) {
    if (starts[i].g1 > 0.0) add_flight(scene, starts[i]);
  }
  return scene;
}

void FlightScore::add(const Flight113& flight, const rivals::Hit& hit, const FlightScene& scene) {
  const double touch = hit.dt - hit.contact;
  if (hit.kind != rivals::Hit::impact || touch > flight.latest()) {
    ++missed;
  } else if (!(touch >= flight.earliest())) {
    ++phantom;
  } else {
    errors.push_back(error_of(hit, flight.truth, scene.model, scene.eta));
  }
}

}  // namespace afm
