// A kick of the bath, in flight, in a chatter sequence, in contact (docs/temperature.md).
#include <cmath>

#include "afm/surface.h"
#include "afm/tip.h"

namespace afm {

void Tip::set_bath(const Bath& bath) {
  thermostat_.set(bath, model_.frequency_ratio, now_);
  // a search ends at the next kick
  if (Flying* flying = std::get_if<Flying>(&phase_)) find_landing(*flying);
}

// Both velocities relative to the holder change. The hammer's lateral velocity is that of its holder and stays.
TipState Tip::kicked(const Kick& kick, const TipState& state) const {
  const double slope = surface_jet(model_.H, state.phase).h1, w = state.g1 + slope * state.u;
  const double du = mechanics_.is_free_along_x == 0.0 ? 0.0 : kick.lateral.change(state.u - eta_);
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

// Contact goes on if the gap rate after the kick is below the threshold at which chatter becomes contact.
bool Tip::stays_after(const Kick& kick) const {
  const double least = std::fmax(slowest_chatter_, kMinGapRate);
  return in_contact() && std::fabs(kicked(kick, tip_state()).g1) < least;
}

Outcome Tip::kick(Segments* ended) {
  const Kick kick = thermostat_.draw();
  const bool stays = stays_after(kick);
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
