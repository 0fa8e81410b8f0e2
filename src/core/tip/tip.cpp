#include "afm/tip.h"

#include <algorithm>
#include <cmath>
#include <new>

#include "core/release_noise.h"
#include "core/contact/slide_release.h"
#include "tip_motion.h"

namespace afm {

using namespace detail;

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

Tip::Tip(const Model& model, double eta, const FreeState& start, double contact_tolerance)
    : Tip(model, eta, to_tip_state(model.H, start), contact_tolerance) {}

Tip::Tip(const Model& model, double eta, const TipState& start, double contact_tolerance)
    : model_(checked(model)),
      springs_(model),
      eta_(eta),
      contact_tolerance_(contact_tolerance),
      law_(model, contact_tolerance),
      phase_(std::in_place_type<Flying>, springs_, eta, constrained(checked(start))) {
  Flying& flying = std::get<Flying>(phase_);
  const TipState& launched = flying.flight.launch();
  launched.g == 0.0 && !(launched.g1 < 0.0) ? leave_or_press(flying) : find_landing(flying);
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

void Tip::set_laws(const Model& model) {
  model_ = model;
  springs_ = SpringConstants<double>(model);
  law_ = ChatterLaw(model, contact_tolerance_);
}

// --- A phase begins now ---

// A pull within rounding is no release (release_noise.h): on the glide at eta = 1 the reaction is zero for ever. Nor is
// a gap rate within rounding a flight there: it would bounce at every rounding.
bool Tip::rests(const Flight<double>& flight, Leaves leaves) const {
  constexpr double kGapRateRounding = 1e-15;  // of the velocities that it is the difference of
  const TipState& start = flight.launch();
  if (start.g != 0.0) return false;
  const double g2 = flight.start().g2;
  if (leaves == Leaves::under_any_pull) return start.g1 == 0.0 && g2 < 0.0;
  const double noise = release_noise(springs_, start.u, start.X);
  if (start.g1 == 0.0) return g2 < noise;
  const double slope = surface_jet(model_.H, start.phase).h1;
  return std::fabs(g2) < noise && std::fabs(start.g1) < kGapRateRounding * (1.0 + std::fabs(slope * start.u));
}

void Tip::fly(const TipState& start, Leaves leaves) {
  Flying& flying = phase_.emplace<Flying>(springs_, eta_, constrained(start));
  start_ = now_;
  // a hammer that one command lifts off, and a second command at the same time does not, rests
  rests(flying.flight, leaves) ? touch(flying.flight.launch()) : find_landing(flying);
}

// The search ends just after the next kick, if that comes first.
void Tip::find_landing(Flying& flying) {
  constexpr double kBeyondKick = 1e-6;  // [tau] far above rounding, so that the kick comes before the end of the search
  const double horizon = std::fmin(kSearchHorizon, thermostat_.next() - start_ + kBeyondKick);
  // in its place: a copy would wait for memory
  new (&flying.landing) Landing<double>(afm::find_landing(model_, flying.flight, horizon));
  end_ = flying.landing.s;
}

void Tip::touch(const TipState& state) {
  phase_ = Touching{{state.phase, state.X, state.u, 0.0, 0.0}};
  start_ = now_;
  end_ = 0.0;
}

// A step that follows another one begins with its length.
void Tip::slide(const SlideState<double>& start) {
  const Sliding* before = std::get_if<Sliding>(&phase_);
  const ContactStep::Hint hint = before != nullptr ? before->step.hint() : ContactStep::Hint{};
  const SlideState<double> from{wrap_phase(start.phase), start.X, start.u};
  Sliding& sliding = phase_.emplace<Sliding>(springs_, eta_, from, step_tolerance(contact_tolerance_), hint);
  const double release = sliding.step.find_release();
  sliding.releases = release >= 0.0;
  sliding.begin = {now_, 0.0, 0.0, slide_energy(springs_, from), 0};
  start_ = now_;
  end_ = sliding.releases ? release : sliding.step.length();
}

void Tip::chatter_along(const SlideState<double>& start, const Chatter& chatter, const Sequence& sequence,
                        const Account& begin) {
  const SlideState<double> from{wrap_phase(start.phase), start.X, start.u};
  Chattering& chattering = phase_.emplace<Chattering>(springs_, eta_, from, reference_bits(contact_tolerance_));
  const double release = find_release(chattering.reference);
  chattering.releases = release >= 0.0;
  chattering.chatter = chatter;
  const double until = chattering.releases ? release : chattering.reference.length();
  chattering.run = law_.run(chattering.reference, until, chatter);
  chattering.sequence = sequence;
  chattering.begin = begin;
  start_ = now_;
  end_ = chattering.run.s;
}

// --- Time passes ---

TipState Tip::tip_state() const {
  const auto on_surface = [](const SlideState<double>& q) -> TipState {
    return {wrap_phase(q.phase), q.X, q.u, 0.0, 0.0};
  };
  const double s = now_ - start_;
  if (const Flying* flying = std::get_if<Flying>(&phase_)) {
    TipState state = flying->flight.tip_state(s);
    state.g = std::fmax(state.g, 0.0);
    return state;
  }
  if (const Touching* touching = std::get_if<Touching>(&phase_)) return touching->state;
  if (const Sliding* sliding = std::get_if<Sliding>(&phase_)) return on_surface(sliding->step.at(s));
  return on_surface(std::get<Chattering>(phase_).reference.at(s));
}

// A command ends a phase at now(), not a rounding earlier.
ModelTime Tip::event_time() const {
  if (pending_) return now_;
  const ModelTime end = start_ + end_;
  return end < now_ ? now_ : end;
}

ModelTime Tip::segment_end() const {
  const ModelTime event = event_time();
  return thermostat_.next() < event ? thermostat_.next() : event;
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
  now_ = end;
  if (kicked) return kick(ended);
  if (!pending_) return end_phase(ended);
  last_impact_ = *pending_;
  pending_.reset();
  return last_impact_.kind == ImpactKind::burst ? Outcome::impact : Outcome::released;
}

Outcome Tip::advance(const ModelTime& limit) {
  for (;;) {
    const ModelTime begin = now_;
    const Outcome outcome = advance_segment(limit);
    const bool goes_on = outcome == Outcome::search_failed && begin < now_;
    if (outcome != Outcome::flying && !goes_on) return outcome;
  }
}

}  // namespace afm
