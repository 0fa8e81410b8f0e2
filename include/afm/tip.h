// The hybrid automaton (docs/algorithm.md): flight, impact, chatter, contact, release (Eq. 2-5, 9-11). It knows where the
// tip is at any time up to its next event.
#pragma once

#include "afm/detail/sample_grid.h"
#include "afm/detail/thermostat.h"
#include "bath.h"
#include "chatter.h"
#include "contact.h"
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

// Error allowed in the state at the next impact when chatter is replaced by a burst and a slide [a, a/tau]. At the
// default half of all bursts are good to 4e-6 and 99 in 100 to 2e-4 (docs/stability.md).
constexpr double kDefaultContactTolerance = 1e-3;
constexpr double kMaxContactTolerance = 1e-2;
constexpr double kMinContactTolerance = 1e-9;  // or 0; below it bursts are followed for longer than bounces would take

class Tip {
 public:
  // contact_tolerance 0: every bounce by itself, and contact only where a bounce leaves no gap rate, or one below
  // 1e-16 a/tau. Throws the model's first ParameterError, or one about a start below the surface.
  Tip(const Model& model, double eta, const FreeState& start, double contact_tolerance = kDefaultContactTolerance);
  Tip(const Model& model, double eta, const TipState& start, double contact_tolerance = kDefaultContactTolerance);

  // To the next event or to `limit`, whichever is first; an event at the limit itself still happens. Nothing is split
  // at a limit: any sequence of limits gives the same bits as one.
  Outcome advance(const ModelTime& limit);

  // The same, in arcs: it also stops (Outcome::flying) after a kick and where the search of a long flight has come to.
  // `ended`: the segments that ended with this arc; they do not depend on the limits.
  Outcome advance_segment(const ModelTime& limit, Segments* ended = nullptr);
  ModelTime segment_end();  // up to here, exclusive, deflection() holds

  // The segment under way up to now(). Ask before a command: one that changes something ends it, and no advance yields it.
  // What the command itself changes (a lifted holder, a jolted hammer) is in no segment.
  Segment segment() const;
  double stored_energy() const {
    return account().energy;
  }  // in springs and motion, in the lab, at now() [m a^2/tau^2]

  // A new drag velocity from now() on. It splits the flight, chatter sequence or slide under way. Setting the current
  // velocity again has no effect.
  void drag(double eta);

  // Another restitution, cutoff or height of the holder from now() on. Position and velocity of the tip stay. Lifting the
  // holder works on the spring. A chatter sequence ends with the bounce that is under way; contact goes on if the surface
  // still presses. Precondition: a model without faults that differs in gamma, v_c and y0 at most.
  void set_parameters(const Model& model);

  // Another level of the model from now() on. The tip keeps its place over the surface, height and vertical velocity.
  // To the hammer the holder is put above the tip: the extension and what the horizontal velocity has beyond the
  // holder's are dropped, and the energy in them is returned [m a^2/tau^2] (0 otherwise). To the oscillator nothing
  // changes: the spring is relaxed, and the tip as fast as its holder. A chatter sequence ends with the bounce that is
  // under way. Contact ends where the hammer's gap rate differs from the oscillator's. Both are reported as events at now().
  double set_model(ModelKind kind, double contact_tolerance);

  // Another heat bath from now() on; none at first. Its kicks (docs/temperature.md) are part of every advance: each splits
  // the flight, chatter sequence or contact at its own time, and only there. A kick into the surface on which the tip
  // rides is an impact at once, one away from it leaves. A chatter sequence ends with the bounce that is under way.
  // Precondition: a bath without faults.
  void set_bath(const Bath& bath);
  const Thermostat& thermostat() const { return thermostat_; }

  // For those who fly many at once (ensemble.h): the flight under way, where it is one, and when it began; and the tip
  // as it is after an impact at that time, which was `last` and from which it launches so.
  bool in_flight() const { return mode_ == Mode::flying; }
  const Flight<double>& flight() const { return flight_; }
  ModelTime flight_start() const { return start_; }
  void resume(const TipState& launched, const ModelTime& start, const Impact& last);
  const Model& model() const { return model_; }
  const ChatterLaw& chatter_law() const { return law_; }
  double entry_speed() const { return entry_speed_; }  // slower bounces may be the first of a burst [a/tau]

  ModelTime now() const { return now_; }
  double eta() const { return eta_; }
  bool in_contact() const { return mode_ == Mode::sliding; }
  bool in_chatter() const { return mode_ == Mode::chattering; }
  const Impact& last_impact() const { return last_impact_; }
  TipState tip_state() const;  // at now()
  FreeState state() const { return to_free_state(model_.H, tip_state()); }
  Deflection deflection(const ModelTime& t) const;  // from the last event to arc_end()
  // The same at n times of a grid, the first-th and those after it, bit for bit and several in one instruction where
  // the machine can. Returns the lowest gap [a].
  double deflections(const SampleGrid& grid, std::uint64_t first, std::size_t n, double* vertical,
                     double* lateral) const;

 private:
  friend class StateFields;  // saved_state.cpp

  enum class Mode : std::uint8_t { flying, chattering, touching, sliding };  // touching: contact begins now

  TipState held(const TipState& state) const;
  struct SequenceState {
    SlideState<double> moved;
    double gain, impulse, energy;  // of the sequence so far; energy: stored
  };

  Chatter chatter_now() const;
  SequenceState sequence_state(double s, const Chatter& chatter) const;
  double slide_impulse(double s) const;
  double chatter_loss(double v, double gain) const;
  double bounce_impulse(const SlideState<double>& at, double v) const;
  bool sequence_goes_on() const;
  Account account() const;
  Account account_at(double s, const Chatter& chatter) const;
  Account account_at_begin() const;
  Account account_at_end() const;
  Account flight_account(const FlightState<double>& state) const;
  Segment segment_to(const Account& end) const;
  Segment impact_segment(double energy_before) const;
  Segment kick_segment(const TipState& before, const TipState& after) const;
  TipState kicked(const Kick& kick, const TipState& state) const;
  bool stays_after(const Kick& kick) const;
  void split_account();
  void jolt(double eta);
  void end_slide_now();
  void leave_now();
  void set_tolerance(double contact_tolerance);
  void set_laws(const Model& model);
  void fly(const TipState& start);
  void slide(const SlideState<double>& start);
  void slide(const SlideState<double>& start, int bits);
  void burst(const SlideState<double>& reference, const Chatter& chatter);
  SlideState<double> leave_reference(double s, const Chatter& chatter);
  void begin_flight();
  void leave_or_press();
  bool on_slide() const { return mode_ == Mode::sliding || mode_ == Mode::chattering; }
  void find_landing();
  ModelTime event_time();
  Outcome end_segment();
  Outcome end_segment(Segments& ended);
  Outcome end_segment(Segments* ended) { return ended == nullptr ? end_segment() : end_segment(*ended); }
  Outcome kick(Segments* ended);
  Outcome land();
  Outcome touch();
  Outcome end_flight();
  Outcome end_chatter();
  Outcome end_slide();

  Model model_;
  Mechanics<double> mechanics_;
  double eta_;
  double slowest_chatter_;  // [a/tau] below it, contact
  ChatterLaw law_;
  double entry_speed_;  // slower chatter moves the tip along the surface by less than the tolerance
  Flight<double> flight_;
  SlideSegment<double> slide_;
  Mode mode_ = Mode::flying;
  ModelTime start_, now_;  // of the present arc; the present
  Landing<double> landing_{};
  bool landing_known_ = false;
  double slide_end_ = 0.0;
  bool slide_releases_ = false;
  Chatter chatter_{};                // at the start of the present piece of a burst
  ChatterRun chatter_run_{};         // over it
  ModelTime sequence_begin_;            // of the chatter sequence, as the next four
  double sequence_normal_speed_ = 0.0;  // with which it began
  double sequence_energy_ = 0.0;        // stored then
  double sequence_gain_ = 0.0;          // since then: lost beyond the fall of v^2/2
  double sequence_impulse_ = 0.0;       // of the holder
  Account split_;                    // at the last command within an arc or a sequence
  bool is_split_ = false;
  Impact last_impact_;
  bool pending_ = false;  // an event at now() that the next advance reports
  Impact pending_impact_;
  Thermostat thermostat_;
};

}  // namespace afm
