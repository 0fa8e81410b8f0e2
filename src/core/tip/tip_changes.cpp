// Commands: drag velocity, parameters and level of the model. A command splits the phase of motion under way (flight,
// chatter sequence or contact) at the present time.
#include <cmath>

#include "afm/tip.h"

namespace afm {

using namespace detail;

void Tip::drag(double eta) {
  if (eta == eta_) return;
  if (model_.kind == ModelKind::hammer && is_on_slide()) return jump_holder_velocity(eta);
  if (const Chattering* chattering = std::get_if<Chattering>(&phase_)) {
    const Chatter chatter = chatter_now(*chattering);
    const SequenceState sequence = sequence_state(*chattering, now_ - start_, chatter);
    eta_ = eta;
    chatter_along(sequence.displaced, {sequence.v, chatter.n}, sequence.sequence, {});
    return split_record();
  }
  const TipState state = tip_state();
  eta_ = eta;
  if (in_contact()) return slide({state.phase, state.X, state.u});
  const bool touches = std::holds_alternative<Touching>(phase_) && constrained(state).g1 == 0.0;
  touches ? touch(constrained(state)) : fly(state);
}

// The hammer on the surface gets the new velocity of its holder at once. So its gap rate jumps: it lifts off, or has an
// impact.
void Tip::jump_holder_velocity(double eta) {
  split_record();
  end_slide_now();
  // A sum that is rounded up would end it later. The ulp of a phase may be far above that of the time.
  while (now_ < start_ + end_) end_ = std::fmax(0.0, std::fmin(std::nextafter(end_, 0.0), end_ - 0x1p-53));
  eta_ = eta;
}

// Lets the next advance end the chatter sequence or contact at now(). The tip is then in the flight that the last
// bounce began. The flight begins now where that one is over already, by the error of the law, or where it would take
// back what was counted as lost in the first bounce before a command.
void Tip::end_slide_now() {
  end_ = now_ - start_;
  if (Sliding* sliding = std::get_if<Sliding>(&phase_)) sliding->releases = true;
  Chattering* chattering = std::get_if<Chattering>(&phase_);
  if (chattering == nullptr) return;
  ChatterRun& run = chattering->run = law_.last_bounce(chattering->reference, end_, chattering->chatter);
  const bool is_first = run.chatter.n == 0.0;
  if (is_first) run.chatter.loss = -chattering->sequence.loss;  // none so far, not by a rounding either
  const bool takes_back = is_first && chattering->begin.loss != 0.0;
  if (run.s < end_ && !takes_back) {
    const SequenceState at = sequence_state(*chattering, run.s, run.chatter);
    const Flight<double> flight(springs_, chattering->reference.eta(), leave_surface(model_, at.displaced, at.v));
    if (flight.gap(end_ - run.s).g > 0.0) {
      chattering->last_flight = flight;
      return;
    }
  }
  run = {ChatterEnd::exits, end_, chatter_now(*chattering)};
}

// A command that leaves the tip on the surface ends the record within the phase.
void Tip::split_record() {
  const Account now = account();
  if (Sliding* sliding = std::get_if<Sliding>(&phase_)) sliding->begin = now;
  if (Chattering* chattering = std::get_if<Chattering>(&phase_)) chattering->begin = now;
}

void Tip::set_parameters(const Model& model) {
  if (model.gamma == model_.gamma && model.v_c == model_.v_c && model.y0 == model_.y0) return;
  if (in_chatter() || has_jumped()) leave_now();
  const TipState state = tip_state();
  set_laws(model);
  if (in_contact()) return slide({state.phase, state.X, state.u});
  fly(state, Leaves::above_rounding);
}

// A hammer whose holder has jumped leaves its contact with the next advance; a slide that began anew would forget it.
bool Tip::has_jumped() const {
  const Sliding* sliding = std::get_if<Sliding>(&phase_);
  return sliding != nullptr && sliding->step.eta() != eta_;
}

// Ends the chatter sequence or contact at once. The next advance reports the event, if it is one.
void Tip::leave_now() {
  end_slide_now();
  if (end_phase(nullptr) != Outcome::flying) pending_ = last_impact_;
}

double Tip::set_model(ModelKind kind, double contact_tolerance) {
  const bool drops = kind == ModelKind::hammer && model_.kind == ModelKind::oscillator;
  if (in_chatter() || has_jumped() || (in_contact() && drops)) leave_now();
  const TipState state = tip_state();
  const double spring = springs_.omega_h * state.X;
  Model model = model_;
  model.kind = kind;
  contact_tolerance_ = contact_tolerance;
  set_laws(model);
  if (in_contact()) {
    slide({state.phase, state.X, state.u});
    return 0.0;
  }
  const TipState launched = constrained(state);
  const bool touches = std::holds_alternative<Touching>(phase_) && launched.g == 0.0 && launched.g1 == 0.0;
  touches ? touch(launched) : fly(state, Leaves::above_rounding);
  if (!drops) return 0.0;
  return 0.5 * (spring * spring + (state.u - eta_) * (state.u + eta_));
}

}  // namespace afm
