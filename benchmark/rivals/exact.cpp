// Ours, one flight: exact flow, guaranteed search, reflection.
#include "afm/flight.h"
#include "afm/landing.h"
#include "afm/reflection.h"
#include "method.h"

namespace afm::rivals {
namespace {

Hit next_impact(const Model& model, double eta, const TipState& start, double horizon) {
  const Flight<double> flight(SpringConstants<double>(model), eta, start);
  const Landing<double> landing = find_landing(model, flight, horizon);
  if (landing.s > horizon) return {Hit::none, horizon, flight.tip_state(horizon), 0.0};
  if (landing.outcome == SearchOutcome::impact) {
    const Reflection r = reflect(model, eta, landing.jet);
    return {Hit::impact, landing.s, r.after, r.energy_loss};
  }
  const bool clear = landing.outcome == SearchOutcome::clear;
  return {clear ? Hit::none : Hit::gave_up, landing.s, flight.tip_state(landing.s), 0.0};
}

}  // namespace

MethodSpec exact_spec() {
  return {"exact", {0.0}, 0.0, [](double) { return next_impact; }};
}

}  // namespace afm::rivals
