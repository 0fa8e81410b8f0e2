#include "afm/tip.h"

#include <algorithm>
#include <cmath>
#include <new>

#include "tip_motion.h"

namespace afm {
namespace {

const Model& checked(const Model& model) {
  const auto faults = find_faults(model);
  if (!faults.empty()) throw faults.front();
  return model;
}

const TipState& checked(const TipState& start) {
  if (!(start.g >= 0.0)) throw ParameterError("initial gap", start.g, "the tip would start below the surface");
  return start;
}

// The flight to the next impact may enlarge an error so much (measured over the bursts of docs/stability.md).
constexpr double kErrorGrowth = 100.0;
// Bounces slower than this may become a burst [a/tau]: what the averages leave out of the first of them is the most of
// a burst's error. 0.027 at the default. By square roots, which every machine rounds alike.
double entry_speed_for(double contact_tolerance) {
  constexpr double kEntry = 2.0;
  return kEntry * std::sqrt(contact_tolerance * std::sqrt(std::sqrt(contact_tolerance)));
}

// The reference slide of a chatter sequence need be no better than a 2500th of the tolerance. Its pieces are 2.7 times as long
// for it. The energy account of the sequence holds all the same.
int reference_bits(double contact_tolerance) {
  constexpr double kPart = 4e-4, kLeast = 1e-15;
  return std::clamp(-std::ilogb(std::max(kPart * contact_tolerance, kLeast)), 22, kSlideBits);
}

// In contact the velocity is good to 1e-14 of itself, or of 1 a/tau.
int contact_bits(double u) { return kSlideBits - std::ilogb(std::fmin(std::fmax(std::fabs(u), 1.0), 0x1p24)); }

}  // namespace

Tip::Tip(const Model& model, double eta, const FreeState& start, double contact_tolerance)
    : Tip(model, eta, to_tip_state(model.H, start), contact_tolerance) {}

Tip::Tip(const Model& model, double eta, const TipState& start, double contact_tolerance)
    : model_(checked(model)),
      mechanics_(model),
      eta_(eta),
      slowest_chatter_(contact_tolerance / kErrorGrowth),
      law_(model, slowest_chatter_),
      entry_speed_(entry_speed_for(contact_tolerance)),
      flight_(mechanics_, eta, held(checked(start))),
      slide_(mechanics_, eta, {start.phase, start.X, start.u}) {
  const TipState& launched = flight_.launch();
  if (launched.g == 0.0 && !(launched.g1 < 0.0)) leave_or_press();
}

// The hammer moves along x with its holder, whatever it did before; its height and vertical velocity are its own.
TipState Tip::held(const TipState& state) const {
  TipState s = state;
  if (model_.kind == ModelKind::hammer) {
    const double slope = surface_jet(model_.H, state.phase).h1;
    s = {state.phase, 0.0, eta_, state.g, state.g1 + slope * (state.u - eta_)};
  }
  if (s.g == 0.0 && std::fabs(s.g1) < kLeastGapRate) s.g1 = 0.0;
  return s;
}

void Tip::fly(const TipState& start) {
  launch(mechanics_, eta_, held(start), flight_);
  begin_flight();
  const GapJet<double>& gap = flight_.start();
  // a hammer that one command throws off and the next, at the same time, does not
  if (gap.g == 0.0 && gap.g1 == 0.0 && gap.g2 < 0.0) mode_ = Mode::touching;
}

void Tip::begin_flight() {
  mode_ = Mode::flying;
  is_split_ = false;
  start_ = now_;
  landing_known_ = false;
}

void Tip::slide(const SlideState<double>& start) {
  slide(start, contact_bits(start.u));
  is_split_ = false;
}

void Tip::slide(const SlideState<double>& start, int bits) {
  slide_from(mechanics_, eta_, {wrap_phase(start.phase), start.X, start.u}, bits, slide_);
  mode_ = Mode::sliding;
  start_ = now_;
  const double release = release_of(slide_);
  slide_releases_ = release >= 0.0;
  slide_end_ = slide_releases_ ? release : slide_.length();
}

void Tip::burst(const SlideState<double>& reference, const Chatter& chatter) {
  slide(reference, reference_bits(kErrorGrowth * slowest_chatter_));
  mode_ = Mode::chattering;
  chatter_ = chatter;
  chatter_run_ = law_.run(slide_, 0.0, slide_end_, chatter);
}

// To where the chatter has moved the tip.
SlideState<double> Tip::leave_reference(double s, const Chatter& chatter) {
  const SequenceState r = sequence_state(s, chatter);
  sequence_gain_ = r.gain;
  sequence_impulse_ = r.impulse;
  return r.moved;
}

// The flight after a bounce has begun: does the surface press, and is it the first bounce of a burst?
void Tip::leave_or_press() {
  const TipState& start = flight_.launch();
  const double g2 = flight_.start().g2;
  if (!(start.g1 > 0.0)) {
    // also where the surface does not press, but only rounding pulls: on the glide at eta = 1 for ever
    if (g2 < release_noise(mechanics_, start.u, start.X)) mode_ = Mode::touching;
  } else if (g2 < 0.0 && start.g1 <= entry_speed_ && law_.holds(flight_)) {
    const Projection projected_tip = project_onto_surface(model_, start);
    sequence_begin_ = now_;
    sequence_normal_speed_ = projected_tip.normal_speed;
    const double v = projected_tip.normal_speed, bounce = bounce_impulse(projected_tip.reference, v);
    sequence_energy_ = slide_energy(mechanics_, projected_tip.reference) + 0.5 * v * v + eta_ * bounce;
    sequence_gain_ = 0.0;
    sequence_impulse_ = -bounce;
    is_split_ = false;
    burst(projected_tip.reference, {projected_tip.normal_speed, 0.0});
  }
}

void Tip::resume(const TipState& launched, const ModelTime& start, const Impact& last) {
  last_impact_ = last;
  now_ = start;
  launch(mechanics_, eta_, launched, flight_);
  begin_flight();
  leave_or_press();
}

void Tip::set_tolerance(double contact_tolerance) {
  slowest_chatter_ = contact_tolerance / kErrorGrowth;
  entry_speed_ = entry_speed_for(contact_tolerance);
}

TipState Tip::tip_state() const {
  if (on_slide()) {
    const SlideState<double> q = slide_at(slide_, now_ - start_);
    return {wrap_phase(q.phase), q.X, q.u, 0.0, 0.0};
  }
  TipState state = state_of(flight_, now_ - start_);
  state.g = std::fmax(state.g, 0.0);
  return state;
}

// To just after the next kick, if that comes first.
void Tip::find_landing() {
  constexpr double kBeyondKick = 1e-6;  // [tau] far above rounding, so that a kick comes before the end of its search
  const double horizon = std::fmin(kSearchHorizon, thermostat_.next() - start_ + kBeyondKick);
  new (&landing_) Landing<double>(afm::find_landing(model_, flight_, horizon));  // in place (tip_motion.cpp)
  landing_known_ = true;
}

ModelTime Tip::segment_end() {
  const ModelTime event = event_time();
  return thermostat_.next() < event ? thermostat_.next() : event;
}

ModelTime Tip::event_time() {
  if (pending_) return now_;
  if (on_slide()) {
    const ModelTime end = start_ + (mode_ == Mode::sliding ? slide_end_ : chatter_run_.s);
    return end < now_ ? now_ : end;  // a jolt ends it now, and not a rounding before the command
  }
  if (mode_ == Mode::touching) return start_;
  if (!landing_known_) find_landing();
  return start_ + landing_.s;
}

Outcome Tip::advance_segment(const ModelTime& limit, Segments* ended) {
  if (ended != nullptr) ended->clear();
  const ModelTime event = event_time();
  const bool kicked = thermostat_.next() < event;
  const ModelTime end = kicked ? thermostat_.next() : event;
  if (limit < end) {
    now_ = now_ < limit ? limit : now_;
    return Outcome::time_limit;
  }
  if (kicked) {
    now_ = end;
    return kick(ended);
  }
  if (pending_) {
    pending_ = false;
    last_impact_ = pending_impact_;
    return last_impact_.kind == ImpactKind::burst ? Outcome::impact : Outcome::released;
  }
  now_ = now_ < end ? end : now_;  // the end of a jolted contact is now, to its last digit
  return end_segment(ended);
}

Outcome Tip::advance(const ModelTime& limit) {
  for (;;) {
    const Outcome outcome = advance_segment(limit);
    if (outcome != Outcome::flying) return outcome;
  }
}

}  // namespace afm
