// The energy balance of the tip (docs/algorithm.md, "Energy"). It is computed on demand.
#include <cmath>

#include "afm/surface.h"
#include "afm/tip.h"
#include "tip_motion.h"

namespace afm {

using namespace detail;

namespace {

double energy_of(const SpringConstants<double>& m, double eta, const FlightState<double>& q) {
  const double u = q.U + eta, spring_h = m.omega_h * q.X, spring_v = m.omega_v * q.Y;
  return 0.5 * (u * u + q.W * q.W + spring_h * spring_h + spring_v * spring_v);
}

// Impulse of the horizontal spring from the time integral of its extension [a tau].
double spring_impulse(const SpringConstants<double>& m, double extension_integral) {
  return -m.omega_h * m.omega_h * extension_integral;
}

// The holder of a hammer balances the reaction along x. Its work is the change of energy. At rest its force is
// constant.
double held_impulse(const SpringConstants<double>& m, double eta, const SlideState<double>& start, double pressure,
                    double s, double work) {
  if (eta != 0.0) return work / eta;
  return surface_jet(m.H, start.phase).h1 * pressure * s;
}

}  // namespace

Chatter Tip::chatter_now(const Chattering& chattering) const {
  return law_.at(chattering.reference, now_ - start_, chattering.chatter);
}

// At the time s of the reference slide. The law gives the energy balance: work of the holder less the energy lost. The
// displaced tip has that energy only to the order of the law, so we take the nearest state that has it. The
// holder of a hammer gives the energy that its bounces gain.
Tip::SequenceState Tip::sequence_state(const Chattering& chattering, double s, const Chatter& chatter) const {
  const SlideSegment<double>& slide = chattering.reference;
  const SlideState<double> reference = slide.at(s);
  const double v0 = chattering.chatter.v, start = slide_energy(springs_, slide.start());
  Sequence sequence = chattering.sequence;
  sequence.loss += chatter.loss;
  if (springs_.is_free_along_x == 0.0) {
    const bool holder_rests = slide.eta() == 0.0;
    const bool has_died = chatter.v == 0.0;  // with its first bounce, where that is below the threshold
    const double v = holder_rests && chatter.n == 0.0 && !has_died ? v0 : chatter.v;  // no bounce has ended
    const double along = slide_energy(springs_, reference), gain = 0.5 * (v - v0) * (v + v0) + chatter.loss;
    if (holder_rests) sequence.loss -= gain;  // it gives nothing
    const double pressure = slide.pressure(0.0);
    sequence.impulse += held_impulse(springs_, slide.eta(), slide.start(), pressure, s, along - start) +
                        held_impulse(springs_, slide.eta(), slide.start(), pressure, 0.0, gain);
    return {reference, v, along + 0.5 * v * v, sequence};
  }
  const double impulse = spring_impulse(springs_, extension_integral(slide, s) + chatter.drift);
  sequence.impulse += impulse;
  const double wanted = start + 0.5 * v0 * v0 + slide.eta() * impulse - chatter.loss;
  const BouncingSlide end = with_energy(springs_, {displaced_reference(model_, reference, chatter), chatter.v}, wanted);
  const double energy = slide_energy(springs_, end.slide) + 0.5 * end.v * end.v;
  // at rest on a crest no state near by has that energy: the loss has the rest, and is not below zero by rounding
  sequence.loss = std::fmax(0.0, sequence.loss + (wanted - energy));
  return {end.slide, end.v, energy, sequence};
}

// Right after a bounce the tip is faster than the average of its chatter. The holder of a hammer has given the impulse
// along x for it; the spring of the oscillator gives none.
double Tip::bounce_impulse(const SlideState<double>& at, double v) const {
  return springs_.is_free_along_x > 0.0 ? 0.0 : surface_jet(model_.H, at.phase).h1 * v;
}

// In a flight the impulse is the change of the lateral velocity.
Account Tip::flight_account(const Flight<double>& flight, const FlightState<double>& q) const {
  return {now_, q.U - flight.start().state.U, 0.0, energy_of(springs_, flight.eta(), q), 0};
}

// `to`: the point of the step at s.
Account Tip::contact_account(const Sliding& sliding, double s, const ContactPoint& to) const {
  const ContactStep& step = sliding.step;
  const double energy = slide_energy(springs_, to.state);
  if (springs_.is_free_along_x > 0.0) return {now_, spring_impulse(springs_, to.extension_integral), 0.0, energy, 0};
  const double work = energy - slide_energy(springs_, step.start()), pressure = step.pressure(step.start());
  return {now_, held_impulse(springs_, step.eta(), step.start(), pressure, s, work), 0.0, energy, 0};
}

Account Tip::chatter_account(const Chattering& chattering, double s, const Chatter& chatter) const {
  const SequenceState r = sequence_state(chattering, s, chatter);
  const double bounce = bounce_impulse(r.displaced, r.v), energy = r.energy + chattering.reference.eta() * bounce;
  return {now_, r.sequence.impulse + bounce, r.sequence.loss, energy, count_so_far(chatter.n)};
}

Account Tip::account_at_begin() const {
  if (const Flying* flying = std::get_if<Flying>(&phase_)) {
    return {start_, 0.0, 0.0, energy_of(springs_, eta_, flying->flight.start().state), 0};
  }
  if (const Touching* touching = std::get_if<Touching>(&phase_)) {
    const TipState& q = touching->state;
    return {start_, 0.0, 0.0, slide_energy(springs_, {q.phase, q.X, q.u}), 0};
  }
  if (const Sliding* sliding = std::get_if<Sliding>(&phase_)) return sliding->begin;
  return std::get<Chattering>(phase_).begin;
}

Account Tip::account() const {
  const double s = now_ - start_;
  if (const Flying* flying = std::get_if<Flying>(&phase_)) return flight_account(flying->flight, flying->flight.at(s));
  if (const Sliding* sliding = std::get_if<Sliding>(&phase_)) {
    return contact_account(*sliding, s, sliding->step.point(s));
  }
  if (const Chattering* chattering = std::get_if<Chattering>(&phase_)) {
    return chatter_account(*chattering, s, chatter_now(*chattering));
  }
  return account_at_begin();
}

// For every phase but contact. Exact to the last digit. Chatter that has died has no normal speed left.
Account Tip::account_at_end() const {
  if (const Flying* flying = std::get_if<Flying>(&phase_)) {
    const bool lands = flying->landing.outcome == SearchOutcome::impact;
    return flight_account(flying->flight, lands ? flying->landing.jet.state : flying->flight.at(end_));
  }
  if (const Chattering* chattering = std::get_if<Chattering>(&phase_)) {
    const ChatterRun& run = chattering->run;
    const Chatter chatter = run.end == ChatterEnd::died ? settled(run.chatter) : run.chatter;
    Account end = chatter_account(*chattering, run.s, chatter);
    if (const auto& flight = chattering->last_flight) {
      const Account flew = flight_account(*flight, flight->at(end_ - run.s));
      end.impulse += flew.impulse;
      end.energy = flew.energy;
    }
    if (run.end != ChatterEnd::died && chatter.n == 0.0) {
      end.loss = 0.0;  // no bounce has ended: not even a rounding is lost
    } else {
      end.count = whole_count(chatter.n);
    }
    return end;
  }
  return account_at_begin();
}

Segment Tip::segment_to(const Account& end) const {
  const Account begin = account_at_begin();
  const Chattering* chattering = std::get_if<Chattering>(&phase_);
  Segment s;
  s.kind = chattering != nullptr ? SegmentKind::chatter : in_contact() ? SegmentKind::contact : SegmentKind::flight;
  s.begin = begin.time;
  s.end = end.time;
  s.eta = chattering != nullptr ? chattering->reference.eta() : eta_;  // a holder that has jumped leaves it now
  s.impulse = end.impulse - begin.impulse;
  s.loss = end.loss - begin.loss;
  s.stored = end.energy - begin.energy;
  s.count = end.count > begin.count ? end.count - begin.count : 0;  // that of an end may be a little less
  return s;
}

Segment Tip::segment() const { return segment_to(account()); }

// The record of last_impact_ without the stored energy. The holder of the hammer takes the impulse along x.
Segment Tip::impact_record(double slope, double gap_rate_change) const {
  Segment s;
  s.kind = SegmentKind::impact;
  s.begin = s.end = now_;
  s.eta = eta_;
  if (springs_.is_free_along_x == 0.0) s.impulse = slope * gap_rate_change;
  s.loss = last_impact_.energy_loss;
  s.count = last_impact_.count;
  return s;
}

// The record of a collapse: bounces that are one event, after which the gap rate is zero.
Segment Tip::collapse_segment(double slope, double gap_rate) const {
  Segment s = impact_record(slope, -gap_rate);
  s.stored = s.work() - s.loss;
  return s;
}

// `after` is the flight that begins with the impact, also where the tip does not fly it.
Segment Tip::impact_segment(const Landing<double>& landing, const Flight<double>& after) const {
  const GapJet<double>& left = after.start();
  Segment s = impact_record(landing.jet.h1, left.g1 - landing.jet.g1);
  s.stored = energy_of(springs_, eta_, left.state) - energy_of(springs_, eta_, landing.jet.state);
  return s;
}

}  // namespace afm
