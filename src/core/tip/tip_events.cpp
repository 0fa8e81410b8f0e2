// The transitions at the end of a phase of motion: impact, chatter, contact, release (docs/algorithm.md).
#include <new>
#include <optional>

#include "afm/reflection.h"
#include "afm/tip.h"
#include "core/release_noise.h"
#include "tip_motion.h"

namespace afm {

using namespace detail;

namespace {

// A flight shorter than this part of the fastest turn may be rounding: 4500 ulp of a phase.
constexpr double kMinFlight = 1e-12;

// A flight that is shorter than rounding, under a force within rounding, is no flight: its end is rounding too. Without
// this a drag of 1e-18 a/tau, which moves no phase, would repeat it for ever.
bool is_rounding(const Flight<double>& flight, double s) {
  const TipState& start = flight.launch();
  return s * bounds_of(flight).fastest < kMinFlight && start.g1 > 0.0 &&
         std::fabs(flight.start().g2) < release_noise(flight.springs(), start.u, start.X);
}

}  // namespace

Outcome Tip::end_phase(Segments* ended) {
  Flying* flying = std::get_if<Flying>(&phase_);
  Chattering* chattering = std::get_if<Chattering>(&phase_);
  const bool goes_on = chattering != nullptr && chattering->goes_on();
  if (const Sliding* sliding = std::get_if<Sliding>(&phase_)) {
    const ContactPoint end = sliding->step.point(end_);
    if (ended != nullptr) ended->add(segment_to(contact_account(*sliding, end_, end)));
    return end_step(*sliding, end.state);
  }
  if (ended != nullptr && !goes_on) ended->add(segment_to(account_at_end()));
  if (flying != nullptr) return end_flight(*flying, ended);
  if (chattering != nullptr) return end_chatter(*chattering);
  return begin_contact(std::get<Touching>(phase_).state);
}

Outcome Tip::end_flight(Flying& flying, Segments* ended) {
  if (flying.landing.outcome == SearchOutcome::impact) return land(flying, ended);
  const bool failed = flying.landing.outcome == SearchOutcome::cap;
  search_failures_ += failed;
  fly(flying.flight.tip_state(flying.landing.s));
  return failed ? Outcome::search_failed : Outcome::flying;
}

// The next flight is constructed in the place of the one that ends: a copy would wait for memory, a tenth of an impact.
// A bounce slower than kMinGapRate loses all its energy.
Outcome Tip::land(Flying& flying, Segments* ended) {
  const Landing<double>& landing = flying.landing;
  const bool rounding = is_rounding(flying.flight, landing.s);
  const Reflection r = reflect(model_, eta_, landing.jet);
  const bool rests = rounding || r.after.g1 < kMinGapRate;
  const TipState after{r.after.phase, r.after.X, r.after.u, 0.0, rests ? 0.0 : r.after.g1};
  new (&flying.flight) Flight<double>(springs_, eta_, after);
  const double loss = rests ? 0.5 * r.normal_speed * r.normal_speed : r.energy_loss;
  last_impact_ = {now_, r.after.phase, r.normal_speed, r.tangential_velocity, loss, ImpactKind::impact, 1};
  if (thermostat_.noise() > 0.0 && !rests) {
    if (const std::optional<Collapse> all = collapse_landing(flying, last_impact_)) {
      last_impact_ = all->impact;
      if (ended != nullptr) ended->add(collapse_segment(landing.jet.h1, landing.jet.g1));
      touch({wrap_phase(all->end.phase), all->end.X, all->end.u, 0.0, 0.0});
      return Outcome::impact;
    }
  }
  if (ended != nullptr) ended->add(impact_segment(landing, flying.flight));
  start_ = now_;
  leave_or_press(flying);
  return Outcome::impact;
}

// After a bounce the tip flies. If the surface presses, contact begins, or a chatter sequence with this bounce.
void Tip::leave_or_press(Flying& flying) {
  const TipState& bounce = flying.flight.launch();
  if (rests(flying.flight, Leaves::above_rounding)) {
    touch(bounce);
  } else if (law_.holds(flying.flight)) {
    begin_chatter(bounce);
  } else {
    find_landing(flying);
  }
}

// Where the reaction vanishes before the first bounce of a sequence ends, that bounce is a flight. It is a copy, as
// the phase that holds it ends here.
void Tip::begin_chatter(TipState bounce) {
  const Projection start = project_onto_surface(model_, bounce);
  const double v = start.normal_speed, impulse = bounce_impulse(start.reference, v);
  const double energy = slide_energy(springs_, start.reference) + 0.5 * v * v + eta_ * impulse;
  chatter_along(start.reference, {v, 0.0}, {v, 0.0, -impulse}, {now_, 0.0, 0.0, energy, 0});
  const ChatterRun& run = std::get<Chattering>(phase_).run;
  if (run.end == ChatterEnd::exits && run.chatter.n == 0.0) fly(bounce);
}

// It goes on along the next reference slide, dies, or exits into a flight. That flight may be under way, and the first
// one: then no bounce has ended.
Outcome Tip::end_chatter(const Chattering& chattering) {
  const ChatterRun run = chattering.run;
  const bool died = run.end == ChatterEnd::died;
  const SequenceState end = sequence_state(chattering, run.s, died ? settled(run.chatter) : run.chatter);
  if (chattering.goes_on()) {
    chatter_along(end.displaced, {end.v, run.chatter.n}, end.sequence, Account(chattering.begin));
    return Outcome::flying;
  }
  const TipState bounce = leave_surface(model_, end.displaced, end.v);
  const std::optional<Flight<double>>& flight = chattering.last_flight;
  const TipState left = flight ? flight->tip_state(end_ - run.s) : bounce;
  if (!died && run.chatter.n == 0.0) {
    fly(left);
    return Outcome::flying;
  }
  last_impact_ = {now_,
                  bounce.phase,
                  end.sequence.normal_speed,
                  project_onto_surface(model_, bounce).tangential_velocity,
                  end.sequence.loss,
                  ImpactKind::burst,
                  whole_count(run.chatter.n)};
  died ? touch(constrained(bounce)) : fly(left);
  return Outcome::impact;
}

Outcome Tip::begin_contact(const TipState& state) {
  const double tangential = project_onto_surface(model_, state).tangential_velocity;
  last_impact_ = {now_, state.phase, 0.0, tangential, 0.0, ImpactKind::contact_begun, 0};
  slide({state.phase, state.X, state.u});
  return Outcome::contact;
}

// Another step follows, or the surface releases the tip.
Outcome Tip::end_step(const Sliding& sliding, const SlideState<double>& q) {
  if (!sliding.releases) {
    const bool failed = !sliding.step.is_accurate();
    search_failures_ += failed;
    slide(q);
    return failed ? Outcome::search_failed : Outcome::flying;
  }
  const TipState state{wrap_phase(q.phase), q.X, q.u, 0.0, 0.0};
  const double tangential = project_onto_surface(model_, state).tangential_velocity;
  last_impact_ = {now_, state.phase, 0.0, tangential, 0.0, ImpactKind::contact_ended, 0};
  fly(state);
  return Outcome::released;
}

}  // namespace afm
