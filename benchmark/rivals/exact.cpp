// Ours, one flight: exact flow, guaranteed search, reflection.
#include "afm/flight.h"
#include "afm/impact_search.h"
#include "afm/reflection.h"
#include "method.h"

namespace afm {
namespace rivals {
namespace {

void launch(const Model& model, double eta, const TipState& start, Flight<double>& flight) {
  flight = Flight<double>(Mechanics<double>(model), eta, start);
}
Hit bounce(const Model& model, double eta, const Landing<double>& landing) {
  const Reflection r = reflect(model, eta, landing.jet);
  return {Hit::impact, landing.s, r.after, r.energy_loss};
}

class Exact : public Method {
 public:
  Hit next_impact(const Model& model, double eta, const TipState& start, double horizon) override {
    launch(model, eta, start, flight_);
    const Landing<double> landing = find_landing(model, flight_, horizon);
    if (landing.s > horizon) return {Hit::none, horizon, flight_.tip_state(horizon), 0.0};
    if (landing.outcome == SearchOutcome::impact) return bounce(model, eta, landing);
    const bool clear = landing.outcome == SearchOutcome::clear;
    return {clear ? Hit::none : Hit::gave_up, landing.s, flight_.tip_state(landing.s), 0.0};
  }

 private:
  Flight<double> flight_{Mechanics<double>(Model{}), 1.0, TipState{0.0, 0.0, 1.0, 1.0, 0.0}};
};

}  // namespace

MethodSpec exact_spec() {
  return {"exact", "contact tolerance", {0.0}, 0.0, [](double) { return std::make_unique<Exact>(); }};
}

}  // namespace rivals
}  // namespace afm
