// A kick of the bath, in flight, in a chatter sequence, in contact (docs/temperature.md).
#include <cmath>

#include "afm/surface.h"
#include "afm/tip.h"
#include "tip_motion.h"

namespace afm {

using namespace detail;

namespace {

// The bounces that a kick starts in contact are one event if they move the tip by less than this times the contact
// tolerance times the normal speed of the kick. K_f by work then changes by less than a standard error (measured:
// benchmark/tolerance_friction.py collapse).
constexpr double kDisplacedByKick = 10.0;

}  // namespace

void Tip::set_bath(const Bath& bath) {
  thermostat_.set(bath, model_.frequency_ratio, now_);
  // a search ends at the next kick
  if (Flying* flying = std::get_if<Flying>(&phase_)) return now_ == start_ ? find_landing(*flying) : fly(tip_state());
  split_record();
}

// Both velocities relative to the holder change. The hammer's lateral velocity is that of its holder and stays.
TipState Tip::kicked(const Kick& kick, const TipState& state) const {
  const double slope = surface_jet(model_.H, state.phase).h1, w = state.g1 + slope * state.u;
  const double du = springs_.is_free_along_x == 0.0 ? 0.0 : kick.lateral.change(state.u - eta_);
  return {state.phase, state.X, state.u + du, state.g, state.g1 + (kick.vertical.change(w) - slope * du)};
}

// Positions stay, so the heat to the bath is the kinetic energy that the tip loses.
Segment Tip::kick_segment(const TipState& before, const TipState& after) const {
  const double slope = surface_jet(model_.H, before.phase).h1;
  const double w = before.g1 + slope * before.u, kicked_w = after.g1 + slope * after.u;
  Segment s;
  s.kind = SegmentKind::kick;
  s.begin = s.end = now_;
  s.eta = eta_;
  s.heat = 0.5 * ((before.u - after.u) * (before.u + after.u) + (w - kicked_w) * (w + kicked_w));
  s.stored = -s.heat;
  return s;
}

// The bounces of the kick are one event, after which contact goes on. Their energy is lost at once.
Outcome Tip::collapse(const TipState& before, const TipState& after, const Projection& onto, double bounces,
                      Segments* ended) {
  const double v = std::fabs(onto.normal_speed), loss = 0.5 * v * v;
  last_impact_ = {now_, before.phase, v, onto.tangential_velocity, loss, ImpactKind::burst, whole_count(bounces)};
  if (ended != nullptr) {
    Segment impact = impact_record(surface_jet(model_.H, before.phase).h1, -after.g1);
    impact.stored = impact.work() - loss;
    ended->add(segment());
    ended->add(kick_segment(before, after));
    ended->add(impact);
  }
  slide(onto.reference);
  return Outcome::impact;
}

Outcome Tip::kick(Segments* ended) {
  const Kick kick = thermostat_.draw();
  bool stays = false;
  if (in_contact()) {
    const TipState before = tip_state(), after = kicked(kick, before);
    const Projection onto = project_onto_surface(model_, after);
    const double v = std::fabs(onto.normal_speed), allowed = kDisplacedByKick * contact_tolerance_ * v;
    const double bounces = law_.collapsing(springs_, eta_, onto.reference, v, allowed);
    if (bounces > 0.0) return collapse(before, after, onto, bounces, ended);
    // below the threshold at which chatter becomes contact, contact goes on without an event
    stays = std::fabs(after.g1) < std::fmax(slowest_chatter_, kMinGapRate);
  }
  Outcome outcome = Outcome::flying;
  if (is_on_slide() && !stays) {
    end_slide_now();
    outcome = end_phase(ended);
  } else if (ended != nullptr) {
    ended->add(segment());
  }
  const TipState before = tip_state();
  TipState after = kicked(kick, before);
  if (stays) after.g1 = 0.0;
  if (ended != nullptr) ended->add(kick_segment(before, after));
  stays ? slide({after.phase, after.X, after.u}) : fly(after);
  return outcome;
}

}  // namespace afm
