// The energy of single impacts, from the samples around them: between two samples of one flight the springs turn
// exactly, so four samples give the states before and after an impact, and with them the energy that left. Impacts
// closer than that to another event (bursts, contact, fast chatter) cannot be judged from what is recorded. And the energy
// balance of a run: work of the drag = lost in impacts + heat to the bath + change of what is stored, between published
// estimates of friction whose ends are in free flight.
#pragma once

#include <afm_emulator/Configuration.h>
#include <afm_emulator/Deflection.h>
#include <afm_emulator/Friction.h>
#include <afm_emulator/ImpactArray.h>

#include <cstdint>
#include <deque>
#include <optional>

#include "afm/detail/sample_grid.h"
#include "afm/detail/thermostat.h"
#include "afm/model.h"
#include "afm/state.h"
#include "afm/units.h"

namespace afm::audit {

struct EnergyReport {
  std::uint64_t events = 0, judged = 0, by_law = 0;
  double energy = 0.0, judged_energy = 0.0;  // lost [J]
  double allowed = 0.0;                      // of the errors below: what rounding of the samples makes of them
  // worst, relative: of lengths (how far the springs swing, and the surface's own), of speeds and energies made of them
  double balance_error = 0.0, position_error = 0.0, speed_error = 0.0;
  double law_error = 0.0;      // energy lost against normal speed and restitution, for every single impact
  std::uint64_t balanced = 0;  // estimates of friction
  double work_error = 0.0;     // of their balance, over the energies in it

  void merge(const EnergyReport& other);
};

class EnergyAudit {
 public:
  explicit EnergyAudit(const afm_emulator::Configuration& configuration);

  void add(const afm_emulator::Deflection& batch);
  void add(const afm_emulator::ImpactArray& batch);
  void add(const afm_emulator::Friction& estimate, const ModelTime& since);  // at the end of a batch
  void add_command(const ModelTime& time, double drag_velocity);
  void set_bath(const Thermostat& kicks) { kicks_ = kicks; }  // from the last event on
  void gap();                                                 // something is missing here
  void change(const Model& model, const SampleGrid& grid);    // what is near is not judged
  void judge(const ModelTime& until);                         // all that lies well before

  const EnergyReport& report() const { return report_; }

 private:
  struct Event {
    ModelTime time;
    std::optional<afm_emulator::Impact> impact;  // none: a command, or a kick of the bath
    double eta = 0.0;                            // before it
  };
  struct Sample {
    double X, Y;  // [a]
  };
  struct Estimate {
    ModelTime time, since;
    double given, scale;  // work of the drag - lost - heat since then; the sum of the three [m a^2/tau^2]
  };
  struct Balance {
    ModelTime since;
    double given, stored;
  };
  struct Motion {
    double X, Y, U, W;  // against the holder
  };

  double conditioning() const;
  void push(const Event& event);
  void judge_law(const afm_emulator::Impact& impact);
  bool flies_off() const;
  void judge_impact(const Event& before, const Event& event, const Event& after);
  void judge_estimates(const Event& before, const Event& after);
  void judge_balance(const Estimate& estimate, const Motion& motion, double eta);
  bool flies_between(const Event& before, const Event& after);
  bool is_heard(std::uint64_t sample) const;
  std::uint64_t last_sample_before(const ModelTime& time) const;
  Motion motion(std::uint64_t first, const ModelTime& at) const;  // from this sample and the next
  double energy(const Motion& motion) const;

  const Units units_;
  Model model_;
  SampleGrid grid_;
  const double omega_[2];  // horizontal, vertical [rad/tau]
  double conditioning_;
  double eta_;
  Thermostat kicks_;
  std::deque<Event> events_;
  std::deque<Sample> samples_;
  std::deque<Estimate> estimates_;
  std::optional<Balance> base_;                           // where the balance begins
  std::uint8_t last_kind_ = afm_emulator::Impact::BURST;  // of the last event before the first of events_
  bool knows_last_ = false;
  std::uint64_t first_sample_ = 0;
  EnergyReport report_;
};

}  // namespace afm::audit
