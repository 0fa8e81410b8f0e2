#include "afm_emulator/tip.h"

#include <cmath>

#include "afm_emulator/double_double.h"
#include "afm_emulator/reflection.h"

namespace afm {
namespace {

// A flight without an impact is searched this far and then begun anew from there [tau].
constexpr double kHorizon = 8.0;

const Model& checked(const Model& model) {
  const auto faults = find_faults(model);
  if (!faults.empty()) throw faults.front();
  return model;
}

const FreeState& checked(const Model& model, const FreeState& start) {
  const double gap = to_tip_state(model.H, start).g;
  if (!(gap >= 0.0)) throw ParameterError("initial_height", start.y, "the tip would start below the surface");
  return start;
}

Landing<double> rounded(const Landing<DoubleDouble>& landing) {
  const auto d = [](const DoubleDouble& x) { return static_cast<double>(x); };
  const FlightState<DoubleDouble>& q = landing.jet.state;
  const GapJet<double> jet{d(landing.jet.g), d(landing.jet.g1), d(landing.jet.g2),
                           {d(q.phase), d(q.X), d(q.U), d(q.Y), d(q.W)}};
  return {landing.outcome, d(landing.s), jet, landing.evaluations};
}

// A graze closer than double can tell is decided on the same start in twice the digits; one that even they cannot
// tell from a touch is a touch.
Landing<double> decide_graze(const Model& model, double eta, const TipState& start) {
  const Mechanics<DoubleDouble> mechanics(model);
  const Flight<DoubleDouble> flight(mechanics, DoubleDouble(eta), start);
  Landing<double> landing = rounded(find_impact(flight, DoubleDouble(kHorizon)));
  if (landing.outcome == SearchOutcome::undecided) landing.outcome = SearchOutcome::impact;
  return landing;
}

}  // namespace

Tip::Tip(const Model& model, double eta, const FreeState& start, const ModelTime& time)
    : model_(checked(model)),
      mechanics_(model),
      flight_(mechanics_, eta, to_tip_state(model.H, checked(model, start))),
      start_(time),
      now_(time) {}

void Tip::start_flight(double eta, const TipState& start, const ModelTime& time) {
  flight_ = Flight<double>(mechanics_, eta, start);
  start_ = time;
  landing_known_ = false;
}

void Tip::drag(double eta) { start_flight(eta, tip_state(), now_); }

TipState Tip::tip_state() const {
  TipState state = flight_.tip_state(now_ - start_);
  state.g = std::fmax(state.g, 0.0);
  return state;
}

Deflection Tip::deflection(const ModelTime& t) const {
  const GapJet<double> jet = flight_.gap(t - start_);
  return {jet.state.Y, jet.state.X, jet.g};
}

void Tip::find_landing() {
  landing_ = find_impact(flight_, kHorizon);
  if (landing_.outcome == SearchOutcome::undecided) {
    landing_ = decide_graze(model_, flight_.eta(), flight_.tip_state(0.0));
  }
  landing_known_ = true;
}

Outcome Tip::land() {
  const Reflection r = reflect(model_, flight_.eta(), landing_.jet.state, std::fmin(landing_.jet.g1, 0.0));
  now_ = start_ + landing_.s;
  last_impact_ = {now_, r.after.phase, r.normal_speed, r.tangential_velocity, r.energy_loss, ImpactKind::impact, 1};
  start_flight(flight_.eta(), r.after, now_);
  return Outcome::impact;
}

ModelTime Tip::arc_end() {
  if (!landing_known_) find_landing();
  return start_ + landing_.s;
}

Outcome Tip::advance_arc(const ModelTime& limit) {
  const ModelTime end = arc_end();
  if (limit < end) {
    now_ = now_ < limit ? limit : now_;
    return Outcome::time_limit;
  }
  if (landing_.outcome == SearchOutcome::impact) return land();
  const bool failed = landing_.outcome == SearchOutcome::cap;
  start_flight(flight_.eta(), flight_.tip_state(landing_.s), end);
  now_ = end;
  return failed ? Outcome::search_failed : Outcome::flying;
}

Outcome Tip::advance(const ModelTime& limit) {
  for (;;) {
    const Outcome outcome = advance_arc(limit);
    if (outcome != Outcome::flying) return outcome;
  }
}

}  // namespace afm
