#include "afm_emulator/tip.h"

#include <cmath>

#include "afm_emulator/multiversion.h"
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

AFM_MULTIVERSION Flight<double> launch(const Mechanics<double>& mechanics, double eta, const TipState& state) {
  return Flight<double>(mechanics, eta, state);
}

AFM_MULTIVERSION Reflection bounce(const Model& model, double eta, const GapJet<double>& incident) {
  return reflect(model, eta, incident.state, std::fmin(incident.g1, 0.0));
}

AFM_MULTIVERSION GapJet<double> jet_of(const Flight<double>& flight, double s) { return flight.gap(s); }

}  // namespace

Tip::Tip(const Model& model, double eta, const FreeState& start, const ModelTime& time)
    : model_(checked(model)),
      mechanics_(model),
      flight_(mechanics_, eta, to_tip_state(model.H, checked(model, start))),
      start_(time),
      now_(time) {}

void Tip::start_flight(double eta, const TipState& start, const ModelTime& time) {
  flight_ = launch(mechanics_, eta, start);
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
  const GapJet<double> jet = jet_of(flight_, t - start_);
  return {jet.state.Y, jet.state.X, jet.g};
}

void Tip::find_landing() {
  landing_ = afm::find_landing(model_, flight_, kHorizon);
  landing_known_ = true;
}

Outcome Tip::land() {
  const Reflection r = bounce(model_, flight_.eta(), landing_.jet);
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
