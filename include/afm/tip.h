// The hybrid automaton (docs/algorithm.md): flight, impact, chatter, contact, release (Eq. 9-11 of the paper).
// Guarantees: no impact is missed, the gap is never negative beyond rounding, and every energy balance closes to
// rounding. Natural units.
#pragma once

#include <optional>
#include <variant>

#include "afm/detail/phases.h"
#include "bath.h"
#include "model.h"
#include "sample_grid.h"
#include "segment.h"
#include "spring_constants.h"
#include "state.h"
#include "thermostat.h"

namespace afm {

struct Deflection {
  double vertical;  // y - y0 [a]
  double lateral;   // x - xc [a]
  double gap;       // y - h(x) [a]
};

// The contact tolerance: error allowed in the state at the next impact when chatter is computed as a sequence [a,
// a/tau]. At the default, and from eta = 0.2 on, 99 of 100 sequences have an error below it, and half of them one below
// 2.2e-5 (docs/stability.md).
constexpr double kDefaultContactTolerance = 1e-3;
constexpr double kMaxContactTolerance = 1e-2;  // a choice: ten times the default
constexpr double kMinContactTolerance = 1e-9;  // or 0; below it a sequence takes longer than its bounces one by one
inline bool is_contact_tolerance(double t) {
  return t == 0.0 || (t >= kMinContactTolerance && t <= kMaxContactTolerance);
}

// The tip at a time, in one of its phases: what another tip is made from that goes on with the same motion.
struct TipSnapshot {
  // touching: the tip is on the surface, and contact begins at `time`
  enum class Phase : std::uint8_t { flight, contact, chatter, touching };

  Phase phase = Phase::flight;
  ModelTime time;
  TipState state;  // gap and gap rate are 0 but in flight
  // of a chatter sequence
  double sequence_normal_speed = 0.0;  // after its first bounce [a/tau]
  double sequence_gain = 0.0;          // energy lost beyond the fall of v^2/2 [m_tip a^2/tau^2]
  double chatter_speed = 0.0;          // normal speed after the last bounce [a/tau]
  double chatter_count = 0.0;          // bounces so far
};

// Every fault; a tip without any ends its phase.
std::vector<ParameterError> find_faults(const TipSnapshot& tip, const Model& model);

class Tip {
 public:
  // contact_tolerance 0: every bounce by itself; contact begins with a gap rate below kMinGapRate. Throws the first
  // ParameterError of the model, or one about a start below the surface. Preconditions: what else find_faults() of the
  // same RunSettings finds (run.h), such as |eta| above kMaxEta; a tip that is no number has impacts for ever.
  Tip(const Model& model, double eta, const FreeState& start, double contact_tolerance = kDefaultContactTolerance);
  Tip(const Model& model, double eta, const TipState& start, double contact_tolerance = kDefaultContactTolerance);

  // Goes on from a snapshot. Preconditions: without faults, like the model and the bath of the thermostat.
  Tip(const Model& model, double eta, const TipSnapshot& start, double contact_tolerance, const Thermostat& thermostat);
  // The phase at now(). Precondition: is_settled().
  TipSnapshot snapshot() const;
  bool is_settled() const;  // false: an event at now() is still to be reported

  // To the next event or to `limit`, whichever is first: impact, contact, released or time_limit. An event at the limit
  // itself still happens. A failed search is counted and goes on from where the flight is certified; only one that
  // cannot go on is returned (search_failed). Guarantee: any sequence of limits gives the same bits as one, because a
  // limit splits no motion.
  Outcome advance(const ModelTime& limit);
  std::uint64_t search_failures() const { return search_failures_; }  // so far; also of steps in contact

  // The same, one segment of motion at a time. It also stops (Outcome::flying) after a kick, at the horizon of a
  // search, and at the end of a step in contact. `ended`: the records that end with it; they do not depend on
  // the limits.
  Outcome advance_segment(const ModelTime& limit, Segments* ended = nullptr);
  ModelTime segment_end() const;  // deflection() is valid before this time

  // The record of the segment under way, up to now(). Ask for it before a command: a command that changes something
  // ends the segment, and no advance reports it. The energy that the command itself adds (a lifted holder) is in no
  // record.
  Segment segment() const;
  double stored_energy() const { return account().energy; }  // in springs and motion, in the lab [m_tip a^2/tau^2]

  // A new drag velocity from now() on. It splits the flight, chatter sequence or contact under way. Setting the current
  // drag velocity again has no effect. A hammer in contact has the new velocity from the next advance on.
  void drag(double eta);

  // Another restitution, cutoff or rest height from now() on. Position and velocity of the tip stay. A chatter sequence
  // ends at once: the tip is in the flight after its last bounce. Lifting the holder does work on the spring. Contact
  // goes on if the surface still presses; a hammer that was dragged just now leaves it, which is an event at now().
  // Setting the current values has no effect. Precondition: a model without faults that differs in gamma, v_c and y0 at
  // most.
  void set_parameters(const Model& model);

  // Another level of the model from now() on. The tip keeps its surface phase, height and vertical velocity. A change
  // to the hammer moves the holder above the tip: extension and relative horizontal velocity are dropped, and their
  // energy is returned [m_tip a^2/tau^2] (0 otherwise). A change to the oscillator starts with a relaxed spring and the
  // velocity of the holder. A chatter sequence ends at once, as above. Contact ends with a change to the hammer. Both
  // are reported as events at now().
  double set_model(ModelKind kind, double contact_tolerance);

  // Another heat bath from now() on; a new tip has none. It splits the flight or the record under way. Every advance
  // includes its kicks (docs/temperature.md). A kick splits the phase under way at its time. In contact, a kick into
  // the surface is an impact at once, and a kick away from it starts a flight; one too weak to lift the tip damps it
  // without an event. Where the bounces after a kick, or with a temperature after an impact, hardly move the tip, they
  // are one event, and the tip is in contact. A chatter sequence ends at once, as above. Setting the current bath has
  // no effect, nor has a change of one that is off to another that is. Precondition: a bath without faults.
  void set_bath(const Bath& bath);
  const Thermostat& thermostat() const { return thermostat_; }

  bool in_flight() const { return std::holds_alternative<Flying>(phase_); }
  const Model& model() const { return model_; }
  ModelTime now() const { return now_; }
  double eta() const { return eta_; }
  double contact_tolerance() const { return contact_tolerance_; }
  bool in_contact() const { return std::holds_alternative<Sliding>(phase_); }
  bool in_chatter() const { return std::holds_alternative<Chattering>(phase_); }
  const Impact& last_impact() const { return last_impact_; }
  // In a chatter sequence state and deflection are those of the reference slide, without the bounces.
  TipState tip_state() const;  // at now()
  FreeState state() const { return to_free_state(model_.H, tip_state()); }
  Deflection deflection(const ModelTime& t) const;  // precondition: now() <= t < segment_end()
  // The same at n times of a grid, from its sample `first` on. Returns the lowest gap [a].
  double deflections(const SampleGrid& grid, std::uint64_t first, std::size_t n, double* vertical,
                     double* lateral) const;

 private:
  using Flying = detail::Flying;
  using Touching = detail::Touching;
  using Sliding = detail::Sliding;
  using Chattering = detail::Chattering;
  using Chatter = detail::Chatter;
  using Sequence = detail::Sequence;
  using SequenceState = detail::SequenceState;
  using Account = detail::Account;
  using Leaves = detail::Leaves;

  TipState constrained(const TipState& state) const;
  void set_laws(const Model& model);
  ModelTime event_time() const;

  // phases begin (tip.cpp)
  void fly(const TipState& start, Leaves leaves = Leaves::under_any_pull);
  void find_landing(Flying& flying);
  void touch(const TipState& state);
  void slide(const detail::SlideState<double>& start);
  void chatter_along(const detail::SlideState<double>& start, const Chatter& chatter, const Sequence& sequence,
                     const Account& begin);
  bool rests(const Flight<double>& flight, Leaves leaves) const;

  // phases end (tip_events.cpp)
  Outcome end_phase(Segments* ended);
  Outcome end_flight(Flying& flying, Segments* ended);
  Outcome land(Flying& flying, Segments* ended);
  void leave_or_press(Flying& flying);
  void begin_chatter(TipState bounce);
  Outcome begin_contact(const TipState& state);
  Outcome end_step(const Sliding& sliding, const detail::SlideState<double>& q);
  Outcome end_chatter(const Chattering& chattering);

  // commands and kicks (tip_changes.cpp, tip_kick.cpp)
  bool is_on_slide() const { return in_contact() || in_chatter(); }
  void jump_holder_velocity(double eta);
  void end_slide_now();
  bool has_jumped() const;
  void leave_now();
  void split_record();
  TipState kicked(const Kick& kick, const TipState& state) const;
  Outcome kick(Segments* ended);
  std::optional<detail::Collapse> collapse(const detail::SlideState<double>& from, double v, double kick,
                                           const Impact& first) const;
  std::optional<detail::Collapse> collapse_kick(const TipState& before, const TipState& after,
                                                const detail::Projection& onto) const;
  std::optional<detail::Collapse> collapse_landing(const Flying& flying, const Impact& impact) const;

  // energy balance (tip_account.cpp)
  Chatter chatter_now(const Chattering& chattering) const;
  SequenceState sequence_state(const Chattering& chattering, double s, const Chatter& chatter) const;
  double bounce_impulse(const detail::SlideState<double>& at, double v) const;
  Account account() const;
  Account account_at_begin() const;
  Account account_at_end() const;
  Account flight_account(const Flight<double>& flight, const FlightState<double>& state) const;
  Account contact_account(const Sliding& sliding, double s, const detail::ContactPoint& to) const;
  Account chatter_account(const Chattering& chattering, double s, const Chatter& chatter) const;
  Segment segment_to(const Account& end) const;
  Segment impact_record(double slope, double gap_rate_change) const;
  Segment collapse_segment(double slope, double gap_rate) const;
  Segment impact_segment(const Landing<double>& landing, const Flight<double>& after) const;
  Segment kick_segment(const TipState& before, const TipState& after) const;
  void kick_in_contact(const TipState& before, const TipState& after, const detail::SlideState<double>& along,
                       Segments* ended);

  Model model_;
  SpringConstants<double> springs_;
  double eta_;
  double contact_tolerance_;
  detail::ChatterLaw law_;
  Thermostat thermostat_;
  ModelTime start_, now_;
  double end_ = 0.0;  // of the phase under way, since start_ [tau]
  std::variant<Flying, Touching, Sliding, Chattering> phase_;
  Impact last_impact_;
  std::optional<Impact> pending_;  // an event at now() that the next advance reports
  std::uint64_t search_failures_ = 0;
};

}  // namespace afm
