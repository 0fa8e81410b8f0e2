// A run in batches: a tip that is sampled on a regular grid and obeys commands. Guarantee: the output is a function of
// the settings (or of a snapshot) and of the model times of commands and snapshots, to the last bit. So a node can pace
// a run, and a checker can repeat it.
#pragma once

#include <cstdint>
#include <vector>

#include "bath.h"
#include "friction.h"
#include "model.h"
#include "sample_grid.h"
#include "state.h"
#include "tip.h"

namespace afm {

struct RunSettings {
  Model model;
  double eta = 3.4;  // drag velocity at start [a/tau], signed
  FreeState initial{0.25, 0.0, 0.2, 3.4, 0.0};
  double sample_period = 0.03;  // [tau]
  std::uint64_t samples_per_batch = 2000;
  double friction_window = 1000.0;      // [tau]
  std::uint64_t impact_budget = 40000;  // impacts per batch; a batch that spends it ends there
  double contact_tolerance = kDefaultContactTolerance;
  Bath bath;  // none
};

// Every fault, named as in RunSettings; natural units.
std::vector<ParameterError> find_faults(const RunSettings& settings);

// The result of one advance: the samples of [begin, end), and the impacts up to the end.
struct Batch {
  ModelTime begin, end;
  ModelTime first_sample_time;
  std::uint64_t first_sample = 0;  // running index
  std::vector<double> vertical;    // y - y0 [a]
  std::vector<double> lateral;     // x - xc [a]
  std::uint64_t first_impact = 0;  // running index
  std::vector<Impact> impacts;
  std::uint64_t impact_limit = 0;  // 0: it ends at its time; else it ended when it had spent so many impacts
  FrictionEstimate friction;       // at end
  double eta = 0.0;                // drag velocity throughout the batch
  double impulse = 0.0;            // of the holder's lateral force on the tip, exact [m_tip a/tau]
  double holder = 0.0;             // position of the holder at first_sample_time [a]
};

// Counters of trouble; they stay zero in a good run.
struct Counters {
  std::uint64_t budget_exhausted = 0;
  std::uint64_t search_failures = 0;
  double worst_penetration = 0.0;  // deepest sample taken below the surface [a]
};

// Where the holder is: it moves evenly from one drag command to the next. A change to the hammer moves it above the
// tip.
struct HolderPath {
  ModelTime since;
  double from = 0.0;  // position then [a]

  double position(const ModelTime& time, double eta) const { return from + eta * (time - since); }
};

// The state of a run between two batches: what a person would write down to take it up again.
struct Snapshot {
  RunSettings settings;  // in force
  TipSnapshot tip;       // tip.time is the time of the snapshot
  SampleGrid samples;
  std::uint64_t next_sample = 0, next_impact = 0;
  SampleGrid kicks;  // of the bath
  std::uint64_t kick_count = 0;
  HolderPath holder;
  Friction friction{1.0};
};

// Every fault: a run from a snapshot without any ends, and stays within its memory.
std::vector<ParameterError> find_faults(const Snapshot& snapshot);

class Run {
 public:
  explicit Run(const RunSettings& settings);  // throws the first ParameterError
  explicit Run(const Snapshot& snapshot);     // likewise; counters begin at zero

  // All settings from now() on. The state of the tip stays. What stays the same has no effect. A new drag velocity,
  // model, level or bath restarts the friction estimate, a new window restarts its window. A new sample period takes
  // its first sample at now(). Returns the energy that a change to the hammer drops [m_tip a^2/tau^2], as
  // set_model() of a Tip does.
  // Lever and surface (H, frequency_ratio), the start and the budget stay as they are. Precondition: settings without
  // faults.
  double apply(const RunSettings& settings);

  // To the next batch boundary of the sample grid (time_limit), or until impact_budget impacts are spent
  // (budget_spent). It clears the batch and fills it. Guarantee: no allocation if the batch has room for
  // samples_per_batch samples and impact_budget impacts.
  Outcome advance(Batch& batch);
  // The same to an earlier limit, and with another number of impacts.
  Outcome advance(const ModelTime& limit, std::uint64_t impacts, Batch& batch);

  // The state at now(). It splits the motion under way as a command does: this run goes on as one made from the
  // snapshot, with the same bits; a second one at the same time counts as well. No allocation. Precondition:
  // can_split().
  Snapshot split();
  bool can_split() const { return tip_.is_settled(); }  // false: an event at now() is still to be reported

  ModelTime now() const { return tip_.now(); }
  ModelTime next_boundary() const;  // of a batch, after now()
  double eta() const { return settings_.eta; }
  FreeState state() const { return tip_.state(); }         // at now()
  std::uint64_t samples() const { return next_sample_; }   // number due so far
  const SampleGrid& sample_grid() const { return grid_; }  // in force
  std::uint64_t impacts() const { return impact_index_; }  // so far
  const Counters& counters() const { return counters_; }
  const RunSettings& settings() const { return settings_; }  // in force; `initial` is of the start

 private:
  double change_level(const RunSettings& old);
  void begin(Batch& batch) const;
  Outcome run_segments(const ModelTime& end, std::uint64_t impacts, Batch& batch);
  void sample_until(const ModelTime& time, Batch& batch);
  std::uint64_t first_sample_from(const ModelTime& time) const;

  RunSettings settings_;
  Tip tip_;
  HolderPath holder_;
  Friction friction_;
  SampleGrid grid_;
  std::uint64_t next_sample_ = 0;
  std::uint64_t impact_index_ = 0;
  Counters counters_;
};

}  // namespace afm
