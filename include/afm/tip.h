// The hybrid automaton (docs/algorithm.md): flight, impact, chatter, contact, release (Eq. 9-11 of the paper).
// Guarantees: no impact is missed, the gap is never negative beyond rounding, and every energy balance closes to
// rounding. Natural units.
#pragma once

#include "afm/detail/sample_grid.h"
#include "afm/detail/thermostat.h"
#include "bath.h"
#include "chatter.h"
#include "contact.h"
#include "contact_step.h"
#include "flight.h"
#include "impact_search.h"
#include "model.h"
#include "segment.h"
#include "state.h"

namespace afm {

template <class T>
struct DeflectionOf {
  T vertical;  // y - y0 [a]
  T lateral;   // x - xc [a]
  T gap;       // y - h(x) [a]
};
using Deflection = DeflectionOf<double>;

// The contact tolerance: error allowed in the state at the next impact when chatter is computed as a sequence [a,
// a/tau]. At the default half of all sequences have an error below 2e-5, and 99 in 100 below 3e-4 (docs/stability.md).
constexpr double kDefaultContactTolerance = 1e-3;
constexpr double kMaxContactTolerance = 1e-2;  // a choice: ten times the default
constexpr double kMinContactTolerance = 1e-9;  // or 0; below it a sequence takes longer than its bounces one by one

// Slower bounces may begin a chatter sequence [a/tau]: 2 tolerance^(5/8), which is 0.027 at the default.
double chatter_entry_speed(double contact_tolerance);

// The tip at a time, in one of its phases: what another tip is made from that goes on with the same motion.
struct TipSnapshot {
  // touching: the tip is on the surface, and contact begins at `time`
  enum class Phase : std::uint8_t { flight, contact, chatter, touching };

  Phase phase = Phase::flight;
  ModelTime time;
  TipState state;  // gap and gap rate are 0 but in flight
  // of a chatter sequence
  double sequence_normal_speed = 0.0;  // after its first bounce [a/tau]
  double sequence_gain = 0.0;          // energy lost beyond the fall of v^2/2 [m a^2/tau^2]
  double chatter_speed = 0.0;          // normal speed after the last bounce [a/tau]
  double chatter_count = 0.0;          // bounces so far
};

// Every fault; a tip without any ends its phase.
std::vector<ParameterError> find_faults(const TipSnapshot& tip);

class Tip {
 public:
  // contact_tolerance 0: every bounce by itself; contact begins with a gap rate below kMinGapRate. Throws the first
  // ParameterError of the model, or one about a start below the surface.
  Tip(const Model& model, double eta, const FreeState& start, double contact_tolerance = kDefaultContactTolerance);
  Tip(const Model& model, double eta, const TipState& start, double contact_tolerance = kDefaultContactTolerance);

  // Goes on from a snapshot. Preconditions: without faults, like the model and the bath of the thermostat.
  Tip(const Model& model, double eta, const TipSnapshot& start, double contact_tolerance, const Thermostat& thermostat);
  // The phase at now(). Precondition: is_settled().
  TipSnapshot snapshot() const;
  bool is_settled() const;  // false: an event at now() is still to be reported

  // To the next event or to `limit`, whichever is first. An event at the limit itself still happens. Guarantee: any
  // sequence of limits gives the same bits as one, because a limit splits no motion.
  Outcome advance(const ModelTime& limit);

  // The same, one segment of motion at a time. It also stops (Outcome::flying) after a kick, at the horizon of a
  // search, and at the end of a step in contact. `ended`: the records that end with it; they do not depend on
  // the limits.
  Outcome advance_segment(const ModelTime& limit, Segments* ended = nullptr);
  ModelTime segment_end();  // deflection() is valid before this time

  // The record of the segment under way, up to now(). Ask for it before a command: a command that changes something
  // ends the segment, and no advance reports it. The energy that the command itself adds (a lifted holder) is in no
  // record.
  Segment segment() const;
  double stored_energy() const { return account().energy; }  // in springs and motion, in the lab [m a^2/tau^2]

  // A new drag velocity from now() on. It splits the flight, chatter sequence or contact under way. Setting the current
  // drag velocity again has no effect.
  void drag(double eta);

  // Another restitution, cutoff or rest height from now() on. Position and velocity of the tip stay. Lifting the holder
  // does work on the spring. A chatter sequence ends with the bounce under way. Contact goes on if the surface still
  // presses. Precondition: a model without faults that differs in gamma, v_c and y0 at most.
  void set_parameters(const Model& model);

  // Another level of the model from now() on. The tip keeps its surface phase, height and vertical velocity. A change
  // to the hammer moves the holder above the tip: extension and relative horizontal velocity are dropped, and their
  // energy is returned [m a^2/tau^2] (0 otherwise). A change to the oscillator starts with a relaxed spring and the
  // velocity of the holder. A chatter sequence ends with the bounce under way. Contact ends if the gap rate changes.
  // Both are reported as events at now().
  double set_model(ModelKind kind, double contact_tolerance);

  // Another heat bath from now() on; a new tip has none. Every advance includes its kicks (docs/temperature.md). A kick
  // splits the phase under way at its time. In contact, a kick into the surface is an impact at once, and a kick away
  // from it starts a flight. A chatter sequence ends with the bounce under way. Precondition: a bath without faults.
  void set_bath(const Bath& bath);
  const Thermostat& thermostat() const { return thermostat_; }

  bool in_flight() const { return mode_ == Mode::flying; }
  const Flight<double>& flight() const { return flight_; }  // precondition: in_flight()
  ModelTime flight_start() const { return start_; }
  const Model& model() const { return model_; }
  const ChatterLaw& chatter_law() const { return law_; }
  ModelTime now() const { return now_; }
  double eta() const { return eta_; }
  double contact_tolerance() const { return contact_tolerance_; }
  bool in_contact() const { return mode_ == Mode::sliding; }
  bool in_chatter() const { return mode_ == Mode::chattering; }
  const Impact& last_impact() const { return last_impact_; }
  TipState tip_state() const;  // at now()
  FreeState state() const { return to_free_state(model_.H, tip_state()); }
  Deflection deflection(const ModelTime& t) const;  // precondition: now() <= t < segment_end()
  // The same at n times of a grid, from its sample `first` on. Guarantee: the same bits. It computes several at once if
  // the machine has vector registers. Returns the lowest gap [a].
  double deflections(const SampleGrid& grid, std::uint64_t first, std::size_t n, double* vertical,
                     double* lateral) const;

 private:
  // touching: the tip is on the surface, and contact begins at now().
  enum class Mode : std::uint8_t { flying, chattering, touching, sliding };

  // In a chatter sequence: the tip displaced from the reference slide, and totals since the sequence began.
  struct SequenceState {
    SlideState<double> moved;
    double v;                      // normal speed after the last bounce
    double loss, impulse, energy;  // energy lost in the bounces; impulse of the holder; energy stored now
  };

  bool on_slide() const { return mode_ == Mode::sliding || mode_ == Mode::chattering; }

  // phases of motion (tip.cpp)
  TipState constrained(const TipState& state) const;
  void set_tolerance(double contact_tolerance);
  void set_laws(const Model& model);
  void fly(const TipState& start);
  void begin_flight();
  void slide(const SlideState<double>& start);
  void refer_to(const SlideState<double>& start, int bits);
  SlideState<double> surface_state(double s) const;
  void start_chatter(const SlideState<double>& reference, const Chatter& start);
  void leave_or_press();
  void find_landing();
  ModelTime event_time();

  // ends of phases (tip_events.cpp)
  bool sequence_goes_on() const;
  SequenceState leave_reference(double s, const Chatter& chatter);
  Outcome end_segment();
  Outcome end_segment(Segments& ended);
  Outcome end_segment(Segments* ended) { return ended == nullptr ? end_segment() : end_segment(*ended); }
  Outcome land();
  Outcome touch();
  Outcome end_flight();
  Outcome end_chatter();
  Outcome end_slide();

  // commands and kicks (tip_changes.cpp, tip_kick.cpp)
  void jolt(double eta);
  void end_slide_now();
  void leave_now();
  TipState kicked(const Kick& kick, const TipState& state) const;
  bool stays_after(const Kick& kick) const;
  Outcome kick(Segments* ended);

  // energy balance (tip_account.cpp)
  Chatter chatter_now() const;
  SequenceState sequence_state(double s, const Chatter& chatter) const;
  double slide_impulse(double s) const;
  double bounce_impulse(const SlideState<double>& at, double v) const;
  Account account() const;
  Account account_at(double s, const Chatter& chatter) const;
  Account account_at_begin() const;
  Account account_at_end() const;
  Account flight_account(const FlightState<double>& state) const;
  Segment segment_to(const Account& end) const;
  Segment impact_segment(double energy_before) const;
  Segment kick_segment(const TipState& before, const TipState& after) const;
  void split_account();

  Model model_;
  Mechanics<double> mechanics_;
  double eta_;
  double contact_tolerance_;
  double slowest_chatter_;  // threshold of contact [a/tau]
  ChatterLaw law_;
  double entry_speed_;  // chatter_entry_speed()
  Flight<double> flight_;
  ContactStep contact_;         // while sliding
  SlideSegment<double> slide_;  // the reference slide of a chatter sequence
  Mode mode_ = Mode::flying;
  ModelTime start_, now_;  // start of flight_, contact_ or slide_; the present
  Landing<double> landing_{};
  bool landing_known_ = false;
  double slide_end_ = 0.0;  // since start_ [tau]
  bool slide_releases_ = false;
  Chatter chatter_{};         // at start_
  ChatterRun chatter_run_{};  // along slide_
  // of the chatter sequence under way
  ModelTime sequence_begin_;
  double sequence_normal_speed_ = 0.0;  // after its first bounce [a/tau]
  double sequence_energy_ = 0.0;        // stored at its begin
  double sequence_loss_ = 0.0;          // up to start_, as in SequenceState
  double sequence_impulse_ = 0.0;       // up to start_
  Account split_;                       // at the last command within the phase under way
  bool is_split_ = false;
  Impact last_impact_;
  bool pending_ = false;  // an event at now() that the next advance reports
  Impact pending_impact_;
  Thermostat thermostat_;
};

}  // namespace afm
