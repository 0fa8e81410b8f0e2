// Commands: drag velocity, parameters and level of the model. A command splits the phase of motion under way (flight,
// chatter sequence or contact) at the present time.
#include "afm/tip.h"

namespace afm {

Chatter Tip::chatter_now() const { return law_.at(slide_, now_ - start_, chatter_); }

void Tip::drag(double eta) {
  if (eta == eta_) return;
  if (model_.kind == ModelKind::hammer && on_slide()) return jolt(eta);
  const TipState state = tip_state();
  SlideState<double> reference{state.phase, state.X, state.u};
  if (mode_ == Mode::chattering) {
    const Chatter chatter = chatter_now();
    const SequenceState sequence = leave_reference(now_ - start_, chatter);
    eta_ = eta;
    start_chatter(sequence.moved, {sequence.v, chatter.n});
    return split_account();
  }
  eta_ = eta;
  if (mode_ == Mode::sliding) return slide(reference);
  const bool due = mode_ == Mode::touching;
  fly(state);
  if (due && flight_.launch().g1 == 0.0) mode_ = Mode::touching;
}

// The hammer on the surface gets the new velocity of its holder at once. So its gap rate jumps: it lifts off, or has an
// impact.
void Tip::jolt(double eta) {
  end_slide_now();
  eta_ = eta;
  split_account();
}

// Lets the next advance end the chatter sequence or contact at now().
void Tip::end_slide_now() {
  const double s = now_ - start_;
  if (mode_ == Mode::sliding) {
    slide_end_ = s;
    slide_releases_ = true;
  } else {
    chatter_run_ = {ChatterEnd::exits, s, chatter_now()};
  }
}

void Tip::set_laws(const Model& model) {
  model_ = model;
  mechanics_ = Mechanics<double>(model);
  law_ = ChatterLaw(model, slowest_chatter_);
}

void Tip::set_parameters(const Model& model) {
  const TipState state = tip_state();
  SlideState<double> reference{state.phase, state.X, state.u};
  if (mode_ == Mode::chattering) {
    const Chatter chatter = chatter_now();
    const SequenceState sequence = leave_reference(now_ - start_, chatter);
    set_laws(model);
    refer_to(sequence.moved, kSlideBits);
    chatter_ = {sequence.v, chatter.n};
    chatter_run_ = {ChatterEnd::exits, 0.0, chatter_};
    return split_account();
  }
  set_laws(model);
  if (mode_ == Mode::sliding) return slide(reference);
  fly(state);
  if (state.g == 0.0 && state.g1 == 0.0) leave_or_press();
}

// Ends the chatter sequence or contact at once. The next advance reports the event.
void Tip::leave_now() {
  end_slide_now();
  mode_ == Mode::sliding ? end_slide() : end_chatter();
  pending_ = true;
  pending_impact_ = last_impact_;
}

double Tip::set_model(ModelKind kind, double contact_tolerance) {
  const bool drops = kind == ModelKind::hammer && model_.kind == ModelKind::oscillator;
  const bool jolted = mode_ == Mode::sliding && slide_releases_ && start_ + slide_end_ <= now_;
  if (mode_ == Mode::chattering || jolted || (mode_ == Mode::sliding && drops)) leave_now();
  const TipState state = tip_state();
  const double spring = mechanics_.omega_h * state.X;
  Model model = model_;
  model.kind = kind;
  set_tolerance(contact_tolerance);
  set_laws(model);
  if (mode_ == Mode::sliding) {
    slide({state.phase, state.X, state.u});
    return 0.0;
  }
  const bool due = mode_ == Mode::touching;
  fly(state);
  const TipState& launched = flight_.launch();
  if (launched.g == 0.0 && launched.g1 == 0.0) {
    leave_or_press();
    if (due) mode_ = Mode::touching;
  }
  if (!drops) return 0.0;
  return 0.5 * (spring * spring + (state.u - eta_) * (state.u + eta_));
}

}  // namespace afm
