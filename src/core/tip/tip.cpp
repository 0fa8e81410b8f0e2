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

// The flight to the next impact may enlarge an error by this factor (measured: docs/stability.md,
// benchmark/burst_error).
constexpr double kErrorGrowth = 100.0;
// Digits of the reference slide: an error of a 2500th of the tolerance is enough. Its segments are 2.7 times as long
// for it, and 1.7 times as fast at eta = 0.3 (docs/history.md). The energy balance does not depend on it.
int reference_bits(double contact_tolerance) {
  constexpr double kPartOfTolerance = 4e-4;
  constexpr int kMinReferenceBits = 22;  // that of the default tolerance: a larger one does not coarsen the slide
  return std::clamp(-std::ilogb(std::max(kPartOfTolerance * contact_tolerance, 1e-15)), kMinReferenceBits, kSlideBits);
}

// Error of a step in contact: a small part of the tolerance, as many steps follow each other.
double step_tolerance(double contact_tolerance) { return std::max(2e-4 * contact_tolerance, kFinestStep); }

}  // namespace

// The first bounce causes most of a sequence's error; the factor is measured (benchmark/burst_error). Square roots give
// the same bits on every machine.
double chatter_entry_speed(double contact_tolerance) {
  return 2.0 * std::sqrt(contact_tolerance * std::sqrt(std::sqrt(contact_tolerance)));
}

Tip::Tip(const Model& model, double eta, const FreeState& start, double contact_tolerance)
    : Tip(model, eta, to_tip_state(model.H, start), contact_tolerance) {}

Tip::Tip(const Model& model, double eta, const TipState& start, double contact_tolerance)
    : model_(checked(model)),
      mechanics_(model),
      eta_(eta),
      contact_tolerance_(contact_tolerance),
      slowest_chatter_(contact_tolerance / kErrorGrowth),
      law_(model, slowest_chatter_),
      entry_speed_(chatter_entry_speed(contact_tolerance)),
      flight_(mechanics_, eta, constrained(checked(start))),
      slide_(mechanics_, eta, {start.phase, start.X, start.u}) {
  const TipState& launched = flight_.launch();
  if (launched.g == 0.0 && !(launched.g1 < 0.0)) leave_or_press();
}

// The state with the constraint of the hammer, which moves along x with its holder. Height and vertical velocity stay.
TipState Tip::constrained(const TipState& state) const {
  TipState s = state;
  if (model_.kind == ModelKind::hammer) {
    const double slope = surface_jet(model_.H, state.phase).h1;
    s = {state.phase, 0.0, eta_, state.g, state.g1 + slope * (state.u - eta_)};
  }
  if (s.g == 0.0 && std::fabs(s.g1) < kMinGapRate) s.g1 = 0.0;
  return s;
}

void Tip::fly(const TipState& start) {
  launch(mechanics_, eta_, constrained(start), flight_);
  begin_flight();
  const GapJet<double>& gap = flight_.start();
  // a hammer that one command lifts off, and a second command at the same time does not
  if (gap.g == 0.0 && gap.g1 == 0.0 && gap.g2 < 0.0) mode_ = Mode::touching;
}

void Tip::begin_flight() {
  mode_ = Mode::flying;
  is_split_ = false;
  start_ = now_;
  landing_known_ = false;
}

// A step that follows another one begins with its length.
void Tip::slide(const SlideState<double>& start) {
  const ContactStep::Hint hint = mode_ == Mode::sliding ? contact_.hint() : ContactStep::Hint{};
  new (&contact_) ContactStep(mechanics_, eta_, {wrap_phase(start.phase), start.X, start.u},
                              step_tolerance(contact_tolerance_), hint);
  mode_ = Mode::sliding;
  is_split_ = false;
  start_ = now_;
  const double release = contact_.find_release();
  slide_releases_ = release >= 0.0;
  slide_end_ = slide_releases_ ? release : contact_.length();
}

void Tip::refer_to(const SlideState<double>& start, int bits) {
  slide_from(mechanics_, eta_, {wrap_phase(start.phase), start.X, start.u}, bits, slide_);
  mode_ = Mode::chattering;
  start_ = now_;
  const double release = release_of(slide_);
  slide_releases_ = release >= 0.0;
  slide_end_ = slide_releases_ ? release : slide_.length();
}

SlideState<double> Tip::surface_state(double s) const {
  return mode_ == Mode::sliding ? contact_.at(s) : slide_at(slide_, s);
}

void Tip::start_chatter(const SlideState<double>& reference, const Chatter& start) {
  refer_to(reference, reference_bits(kErrorGrowth * slowest_chatter_));
  chatter_ = start;
  chatter_run_ = law_.run(slide_, 0.0, slide_end_, start);
}

// A flight has just begun on the surface. If the surface presses, contact begins, or a chatter sequence with this
// bounce.
void Tip::leave_or_press() {
  const TipState& start = flight_.launch();
  const double g2 = flight_.start().g2;
  if (!(start.g1 > 0.0)) {
    // a pull within rounding is no release (mechanics.h): on the glide at eta = 1 the reaction is zero for ever
    if (g2 < release_noise(mechanics_, start.u, start.X)) mode_ = Mode::touching;
  } else if (g2 < 0.0 && start.g1 <= entry_speed_ && law_.holds(flight_)) {
    const Projection projected_tip = project_onto_surface(model_, start);
    sequence_begin_ = now_;
    sequence_normal_speed_ = projected_tip.normal_speed;
    const double v = projected_tip.normal_speed, bounce = bounce_impulse(projected_tip.reference, v);
    sequence_energy_ = slide_energy(mechanics_, projected_tip.reference) + 0.5 * v * v + eta_ * bounce;
    sequence_loss_ = 0.0;
    sequence_impulse_ = -bounce;
    is_split_ = false;
    start_chatter(projected_tip.reference, {projected_tip.normal_speed, 0.0});
  }
}

void Tip::set_tolerance(double contact_tolerance) {
  contact_tolerance_ = contact_tolerance;
  slowest_chatter_ = contact_tolerance / kErrorGrowth;
  entry_speed_ = chatter_entry_speed(contact_tolerance);
}

TipState Tip::tip_state() const {
  if (on_slide()) {
    const SlideState<double> q = surface_state(now_ - start_);
    return {wrap_phase(q.phase), q.X, q.u, 0.0, 0.0};
  }
  TipState state = state_of(flight_, now_ - start_);
  state.g = std::fmax(state.g, 0.0);
  return state;
}

// The search ends just after the next kick, if that comes first.
void Tip::find_landing() {
  constexpr double kBeyondKick = 1e-6;  // [tau] far above rounding, so that the kick comes before the end of the search
  const double horizon = std::fmin(kSearchHorizon, thermostat_.next() - start_ + kBeyondKick);
  new (&landing_) Landing<double>(afm::find_landing(model_, flight_, horizon));  // in place, see tip_motion.cpp
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
    return end < now_ ? now_ : end;  // a command ends it at now(), not a rounding earlier
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
  now_ = now_ < end ? end : now_;
  return end_segment(ended);
}

Outcome Tip::advance(const ModelTime& limit) {
  for (;;) {
    const Outcome outcome = advance_segment(limit);
    if (outcome != Outcome::flying) return outcome;
  }
}

}  // namespace afm
