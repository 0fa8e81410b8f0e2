// A kick of the bath, in flight, in a chatter sequence, in contact (docs/temperature.md).
#include <cmath>
#include <optional>

#include "afm/reflection.h"
#include "afm/surface.h"
#include "afm/tip.h"
#include "tip_motion.h"

namespace afm {

using namespace detail;

namespace {

// The bounces that a kick starts in contact are one event if they move the tip by less than this times the contact
// tolerance times the normal speed of the kick; with a temperature also, like those after an impact, if by less than
// kDisplacedByNoise times the tolerance times the noise of a kick. Ten times that noise makes K_f by work up to 9 % too
// high; with this it is within the errors of docs/data/collapse_friction.csv
// (benchmark/tolerance_friction.py collapse).
constexpr double kDisplacedByKick = 10.0, kDisplacedByNoise = 30.0;

}  // namespace

void Tip::set_bath(const Bath& bath) {
  const Bath before = thermostat_.bath();
  if (bath == before) return;
  thermostat_.set(bath, model_.frequency_ratio, now_);
  if (!bath.is_on() && !before.is_on()) return;
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

// `first`: the impact before the bounces, if there is one. Its event becomes that of all, and they lose the energy that
// the tip does not keep. A tolerance above the default allows no more: the law is of the lowest order.
std::optional<Collapse> Tip::collapse(const SlideState<double>& from, double v, double kick,
                                      const Impact& first) const {
  const double allowed = std::fmax(kDisplacedByKick * kick, kDisplacedByNoise * thermostat_.noise());
  const double tolerance = std::fmin(contact_tolerance_, kDefaultContactTolerance);
  const std::optional<Chatter> bounces =
      law_.collapsed(springs_, eta_, from, v, tolerance * allowed, thermostat_.next() - now_);
  if (!bounces) return std::nullopt;
  const bool is_held = springs_.is_free_along_x == 0.0;
  Collapse all{first, is_held ? from : displaced_reference(model_, from, *bounces)};
  const double loss = 0.5 * v * v + slide_energy(springs_, from) - slide_energy(springs_, all.end);
  if (!(loss > 0.0)) return std::nullopt;
  const TipState end{wrap_phase(all.end.phase), all.end.X, all.end.u, 0.0, 0.0};
  all.impact.surface_phase = end.phase;
  all.impact.tangential_velocity = project_onto_surface(model_, end).tangential_velocity;
  all.impact.kind = ImpactKind::burst;
  all.impact.energy_loss += loss;
  all.impact.count = whole_count(all.impact.count + bounces->n);
  return all;
}

// A kick into the surface begins with an impact, one away from it with a bounce.
std::optional<Collapse> Tip::collapse_kick(const TipState& before, const TipState& after,
                                           const Projection& onto) const {
  const double kick = std::fabs(onto.normal_speed);
  Impact first{now_, before.phase, kick, onto.tangential_velocity, 0.0, ImpactKind::impact, 0};
  double v = kick;
  if (after.g1 < 0.0) {
    v *= restitution(model_, kick);
    first.energy_loss = 0.5 * (kick - v) * (kick + v);
    first.count = 1;
  }
  return collapse(onto.reference, v, kick, first);
}

std::optional<Collapse> Tip::collapse_landing(const Flying& flying, const Impact& impact) const {
  constexpr double kMaxTurn = 0.5;  // [turns] a choice: a longer first bounce is refused before the slower tests
  if (!(flying.flight.start().g2 < 0.0) || turn_of(flying.flight) > kMaxTurn) return std::nullopt;
  const Projection onto = project_onto_surface(model_, flying.flight.launch());
  return collapse(onto.reference, onto.normal_speed, 0.0, impact);
}

// A kick that does not lift the tip, which goes on `along` the surface: its normal velocity becomes heat. The holder of
// a hammer gives the impulse along x.
void Tip::kick_in_contact(const TipState& before, const TipState& after, const SlideState<double>& along,
                          Segments* ended) {
  if (ended != nullptr) {
    Segment record = kick_segment(before, {along.phase, along.X, along.u, after.g, 0.0});
    if (springs_.is_free_along_x == 0.0) {
      record.impulse = -surface_jet(model_.H, before.phase).h1 * after.g1;
      record.heat = record.work() - record.stored;
    }
    ended->add(segment());
    ended->add(record);
  }
  slide(along);
}

Outcome Tip::kick(Segments* ended) {
  const Kick kick = thermostat_.draw();
  if (in_contact()) {
    const TipState before = tip_state(), after = kicked(kick, before);
    const Projection onto = project_onto_surface(model_, after);
    if (const std::optional<Collapse> all = collapse_kick(before, after, onto)) {
      last_impact_ = all->impact;
      if (ended != nullptr) {
        ended->add(segment());
        ended->add(kick_segment(before, after));
        ended->add(collapse_segment(surface_jet(model_.H, before.phase).h1, after.g1));
      }
      slide(all->end);
      return Outcome::impact;
    }
    // below the threshold at which chatter becomes contact, contact goes on without an event
    if (std::fabs(onto.normal_speed) < std::fmax(law_.constants().threshold, kMinGapRate)) {
      kick_in_contact(before, after, onto.reference, ended);
      return Outcome::flying;
    }
  }
  Outcome outcome = Outcome::flying;
  if (is_on_slide()) {
    end_slide_now();
    outcome = end_phase(ended);
  } else if (ended != nullptr) {
    ended->add(segment());
  }
  const TipState before = tip_state(), after = kicked(kick, before);
  if (ended != nullptr) ended->add(kick_segment(before, after));
  fly(after);
  return outcome;
}

}  // namespace afm
