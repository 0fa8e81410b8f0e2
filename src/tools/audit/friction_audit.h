// The published friction against the recorded impacts: the energy lost since the last change of drag velocity, summed
// again, and K_f = sum dE / (v0^2 T) from it. Windows and standard errors are left to replay_check.
#pragma once

#include <afm_emulator/Configuration.h>
#include <afm_emulator/Friction.h>
#include <afm_emulator/ImpactArray.h>

#include <cstdint>
#include <optional>
#include <vector>

#include "afm/state.h"
#include "afm/units.h"

namespace afm::audit {

// A stretch of constant drag velocity.
struct Stretch {
  double drag_velocity = 0.0, eta = 0.0;  // [m/s], [a/tau]
  double tau = 0.0;                       // its length
  double published = 0.0, error = 0.0;    // K_f at its end and its standard error [m_tip/tau]
  double recomputed = 0.0;                // K_f from the impacts
};

struct FrictionReport {
  std::uint64_t estimates = 0;
  std::uint64_t miscounted = 0;    // estimates whose number of impacts is not that of the record
  double energy_error = 0.0;       // worst relative difference of the energy lost
  double k_f_error = 0.0;          // worst relative difference of K_f, force and their units
  std::vector<Stretch> stretches;  // the longest, at most five

  void add(const Stretch& stretch);
  void merge(const FrictionReport& other);
};

class FrictionAudit {
 public:
  explicit FrictionAudit(const afm_emulator::Configuration& configuration);

  void command(const ModelTime& time, double drag_velocity);
  void change(const ModelTime& time);            // of the model: the estimate begins anew
  void set_tolerance(double contact_tolerance);  // of the level in force [a, a/tau]
  void add(const afm_emulator::ImpactArray& batch);
  void judge(const afm_emulator::Friction& estimate);
  void gap();  // sums begin again at the next estimate
  void finish();

  const ModelTime& since() const { return start_; }  // start of the estimates
  const FrictionReport& report() const { return report_; }

 private:
  struct Sums {
    long double energy = 0.0L;  // [J]
    std::uint64_t count = 0;
  };
  void take_split(const afm_emulator::Friction& estimate);
  void judge_figures(const afm_emulator::Friction& estimate, double energy);
  void close_stretch();

  const Units units_;
  double drag_velocity_;
  ModelTime start_;             // of the present stretch
  Sums sums_;                   // of the impacts in it
  Sums split_;                  // a burst that may have begun before the command, or before what is recorded
  double fastest_burst_ = 0.0;  // m v^2 / 2 of the fastest bounce that may begin a burst [J]
  bool awaits_first_ = true;    // the first event since then
  std::optional<Sums> base_;    // what was lost before our sums began, from the first estimate seen
  std::optional<Stretch> last_;
  FrictionReport report_;
};

}  // namespace afm::audit
