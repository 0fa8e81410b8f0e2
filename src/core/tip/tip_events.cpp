// What happens at the end of a segment of motion: impact, end of a chatter sequence, contact, release, end of a search.
#include "afm/reflection.h"
#include "afm/tip.h"
#include "tip_motion.h"

namespace afm {

Outcome Tip::land() {
  Bounce b;
  rebound(model_, mechanics_, eta_, landing_, flight_, b);
  last_impact_ = {now_, b.phase, b.normal_speed, b.tangential_velocity, b.energy_loss, ImpactKind::impact, 1};
  begin_flight();
  leave_or_press();
  return Outcome::impact;
}

// True: only a Taylor series of the reference slide ends, not the sequence.
bool Tip::sequence_goes_on() const {
  return mode_ == Mode::chattering && chatter_run_.end == ChatterEnd::time && !slide_releases_;
}

// To the state that the chatter has displaced from the reference slide.
Tip::SequenceState Tip::leave_reference(double s, const Chatter& chatter) {
  const SequenceState r = sequence_state(s, chatter);
  sequence_loss_ = r.loss;
  sequence_impulse_ = r.impulse;
  return r;
}

Outcome Tip::end_chatter() {
  const ChatterRun run = chatter_run_;
  if (sequence_goes_on()) {
    const SequenceState now = leave_reference(run.s, run.chatter);
    start_chatter(now.moved, {now.v, run.chatter.n});
    return Outcome::flying;
  }
  const bool died = run.end == ChatterEnd::died;
  const SequenceState end = leave_reference(run.s, died ? settled(run.chatter) : run.chatter);
  const TipState bounce = leave_surface(model_, end.moved, end.v);
  const Projection projected_tip = project_onto_surface(model_, bounce);
  last_impact_ = {now_,
                  bounce.phase,
                  sequence_normal_speed_,
                  projected_tip.tangential_velocity,
                  end.loss,
                  ImpactKind::burst,
                  whole_count(run.chatter.n)};
  fly(bounce);
  if (died) mode_ = Mode::touching;
  return Outcome::impact;
}

Outcome Tip::touch() {
  const TipState state = flight_.launch();
  const double tangential = project_onto_surface(model_, state).tangential_velocity;
  last_impact_ = {now_, state.phase, 0.0, tangential, 0.0, ImpactKind::contact_begun, 0};
  slide({state.phase, state.X, state.u});
  return Outcome::contact;
}

Outcome Tip::end_slide() {
  const SlideState<double> q = contact_.at(slide_end_);
  if (!slide_releases_) {
    const bool failed = !contact_.is_accurate();
    slide(q);
    return failed ? Outcome::search_failed : Outcome::flying;
  }
  const TipState state{wrap_phase(q.phase), q.X, q.u, 0.0, 0.0};
  last_impact_ = {
      now_, state.phase, 0.0, project_onto_surface(model_, state).tangential_velocity, 0.0, ImpactKind::contact_ended,
      0};
  fly(state);
  return Outcome::released;
}

Outcome Tip::end_flight() {
  if (landing_.outcome == SearchOutcome::impact) return land();
  const bool failed = landing_.outcome == SearchOutcome::cap;
  fly(state_of(flight_, landing_.s));
  return failed ? Outcome::search_failed : Outcome::flying;
}

Outcome Tip::end_segment() {
  switch (mode_) {
    case Mode::chattering:
      return end_chatter();
    case Mode::touching:
      return touch();
    case Mode::sliding:
      return end_slide();
    default:
      return end_flight();
  }
}

}  // namespace afm
