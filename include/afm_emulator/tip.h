// The hybrid automaton: flight, impact, flight. Knows where the tip is at any time up to its next event.
#pragma once

#include "afm_emulator/flight.h"
#include "afm_emulator/impact_search.h"
#include "afm_emulator/model.h"
#include "afm_emulator/state.h"

namespace afm {

struct Deflection {
  double vertical;  // y - y0 [a]
  double lateral;   // x - xc [a]
  double gap;       // y - h(x) [a]
};

class Tip {
 public:
  // Throws the model's first ParameterError, or one about a start below the surface.
  Tip(const Model& model, double eta, const FreeState& start, const ModelTime& time = {});

  // To the next event or to `limit`, whichever is first; an event at the limit itself still happens. Nothing is split at
  // a limit: any sequence of limits gives the same bits as one.
  Outcome advance(const ModelTime& limit);

  // The same, in arcs: it also stops (Outcome::flying) where the search of a long flight has come to.
  Outcome advance_arc(const ModelTime& limit);
  ModelTime arc_end();  // up to here, exclusive, deflection() holds

  // A new drag velocity from now() on: the flight under way is split here, and only here.
  void drag(double eta);

  ModelTime now() const { return now_; }
  double eta() const { return flight_.eta(); }
  const Impact& last_impact() const { return last_impact_; }
  TipState tip_state() const;                        // at now()
  FreeState state() const { return to_free_state(model_.H, tip_state()); }
  Deflection deflection(const ModelTime& t) const;   // from the last event to arc_end()

 private:
  void start_flight(double eta, const TipState& start, const ModelTime& time);
  void find_landing();
  Outcome land();

  Model model_;
  Mechanics<double> mechanics_;
  Flight<double> flight_;
  ModelTime start_, now_;
  Landing<double> landing_{};
  bool landing_known_ = false;
  Impact last_impact_;
};

}  // namespace afm
