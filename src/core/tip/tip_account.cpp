// The energy balance of the tip (docs/algorithm.md, "Energy"). It is computed on demand.
#include "afm/surface.h"
#include "afm/tip.h"
#include "tip_motion.h"

namespace afm {
namespace {

double energy_of(const Mechanics<double>& m, double eta, const FlightState<double>& q) {
  const double u = q.U + eta, spring_h = m.omega_h * q.X, spring_v = m.omega_v * q.Y;
  return 0.5 * (u * u + q.W * q.W + spring_h * spring_h + spring_v * spring_v);
}

// Impulse of the horizontal spring from the time integral of its extension [a tau].
double spring_impulse(const Mechanics<double>& m, double stretch) { return -m.omega_h * m.omega_h * stretch; }

// The holder of a hammer balances the reaction along x. Its work is the change of energy. At rest its force is
// constant.
double held_impulse(const Mechanics<double>& m, double eta, const SlideState<double>& start, double pressure, double s,
                    double work) {
  if (eta != 0.0) return work / eta;
  return surface_jet(m.H, start.phase).h1 * pressure * s;
}

}  // namespace

double Tip::slide_impulse(double s) const {
  if (mechanics_.is_free_along_x > 0.0) return spring_impulse(mechanics_, contact_.extension_integral(s));
  const SlideState<double>& start = contact_.start();
  const double work = slide_energy(mechanics_, contact_.at(s)) - slide_energy(mechanics_, start);
  return held_impulse(mechanics_, eta_, start, contact_.pressure(start), s, work);
}

// A chatter sequence at the time s of slide_. A hammer's bounces have gained `gain`, which its holder has given.
Tip::SequenceState Tip::sequence_state(double s, const Chatter& chatter) const {
  const SlideState<double> reference = slide_at(slide_, s);
  const double start = slide_energy(mechanics_, slide_.start()), loss = sequence_loss_ + chatter.loss;
  if (mechanics_.is_free_along_x == 0.0) {
    const double v = chatter.v, gain = 0.5 * (v - chatter_.v) * (v + chatter_.v) + chatter.loss;
    const double along = slide_energy(mechanics_, reference);
    const double pressure = slide_.pressure(0.0);
    const double impulse = held_impulse(mechanics_, eta_, slide_.start(), pressure, s, along - start) +
                           held_impulse(mechanics_, eta_, slide_.start(), pressure, 0.0, gain);
    return {reference, v, loss, sequence_impulse_ + impulse, along + 0.5 * v * v};
  }
  const double impulse = spring_impulse(mechanics_, extension_integral(slide_, s) + chatter.drift);
  const double wanted = start + 0.5 * chatter_.v * chatter_.v + eta_ * impulse - chatter.loss;
  const BouncingSlide end = with_energy(mechanics_, {moved_reference(model_, reference, chatter), chatter.v}, wanted);
  const double energy = slide_energy(mechanics_, end.slide) + 0.5 * end.v * end.v, missing = wanted - energy;
  // at rest on a crest no state near by has the energy: the loss, or before that falls below zero the work, has the rest
  const double lost = std::fmax(0.0, loss + missing), gained = eta_ == 0.0 ? 0.0 : (lost - (loss + missing)) / eta_;
  return {end.slide, end.v, lost, sequence_impulse_ + impulse + gained, energy};
}

// Right after a bounce the tip is faster than the average of its chatter. The holder of a hammer has given the impulse
// along x for it; the spring of the oscillator gives none.
double Tip::bounce_impulse(const SlideState<double>& at, double v) const {
  return mechanics_.is_free_along_x > 0.0 ? 0.0 : surface_jet(model_.H, at.phase).h1 * v;
}

Account Tip::account_at_begin() const {
  if (is_split_) return split_;
  if (mode_ == Mode::chattering) return {sequence_begin_, 0.0, 0.0, sequence_energy_, 0};
  if (mode_ == Mode::sliding) return {start_, 0.0, 0.0, slide_energy(mechanics_, contact_.start()), 0};
  return {start_, 0.0, 0.0, energy_of(mechanics_, eta_, flight_.start().state), 0};
}

// At the time s of the segment under way; `chatter` is the state of a chatter sequence there.
Account Tip::account_at(double s, const Chatter& chatter) const {
  if (mode_ == Mode::chattering) {
    const SequenceState r = sequence_state(s, chatter);
    const double bounce = bounce_impulse(r.moved, r.v), energy = r.energy + eta_ * bounce;
    return {now_, r.impulse + bounce, r.loss, energy, static_cast<std::uint64_t>(chatter.n)};
  }
  if (mode_ == Mode::sliding) {
    return {now_, slide_impulse(s), 0.0, slide_energy(mechanics_, contact_.at(s)), 0};
  }
  return flight_account(flight_state(flight_, s));
}

// In a flight the impulse is the change of the lateral velocity.
Account Tip::flight_account(const FlightState<double>& q) const {
  return {now_, q.U - flight_.start().state.U, 0.0, energy_of(mechanics_, eta_, q), 0};
}

Account Tip::account() const {
  if (mode_ == Mode::touching) return account_at_begin();
  return account_at(now_ - start_, mode_ == Mode::chattering ? chatter_now() : Chatter{});
}

Segment Tip::segment_to(const Account& end) const {
  const Account begin = account_at_begin();
  Segment s;
  s.kind = mode_ == Mode::chattering ? SegmentKind::chatter
           : mode_ == Mode::sliding  ? SegmentKind::contact
                                     : SegmentKind::flight;
  s.begin = begin.time;
  s.end = end.time;
  s.eta = eta_;
  s.impulse = end.impulse - begin.impulse;
  s.loss = end.loss - begin.loss;
  s.stored = end.energy - begin.energy;
  s.count = end.count - begin.count;
  return s;
}

Segment Tip::segment() const { return segment_to(account()); }

// A command that leaves the tip on the surface ends the segment within the phase.
void Tip::split_account() {
  is_split_ = false;
  split_ = account();
  is_split_ = true;
}

// At the end of the segment under way, to the last digit. Chatter that has died has no normal speed left.
Account Tip::account_at_end() const {
  if (mode_ == Mode::touching) return account_at_begin();
  if (mode_ == Mode::sliding) return account_at(slide_end_, {});
  if (mode_ == Mode::flying) {
    const bool lands = landing_.outcome == SearchOutcome::impact;
    return lands ? flight_account(landing_.jet.state) : account_at(landing_.s, {});
  }
  const Chatter chatter =
      chatter_run_.end == ChatterEnd::died ? settled(chatter_run_.chatter) : chatter_run_.chatter;
  Account end = account_at(chatter_run_.s, chatter);
  end.count = whole_count(chatter.n);
  return end;
}

// The flight that begins with it is in the tip, also where the tip does not fly it.
Segment Tip::impact_segment(double energy_before) const {
  const GapJet<double>& after = flight_.start();
  Segment s;
  s.kind = SegmentKind::impact;
  s.begin = s.end = now_;
  s.eta = eta_;
  // the holder of the hammer takes the impulse along x
  if (mechanics_.is_free_along_x == 0.0) s.impulse = landing_.jet.h1 * (after.g1 - landing_.jet.g1);
  s.loss = last_impact_.energy_loss;
  s.stored = energy_of(mechanics_, eta_, after.state) - energy_before;
  s.count = last_impact_.count;
  return s;
}

// A Taylor series of the reference slide that another one follows ends no record.
Outcome Tip::end_segment(Segments& ended) {
  if (sequence_goes_on()) return end_segment();
  const Account end = account_at_end();
  ended.add(segment_to(end));
  const Outcome outcome = end_segment();
  const bool bounced = outcome == Outcome::impact && last_impact_.kind == ImpactKind::impact;
  if (bounced) ended.add(impact_segment(end.energy));
  return outcome;
}

}  // namespace afm
