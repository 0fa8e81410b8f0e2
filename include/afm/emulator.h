// A run in batches: a tip that is sampled on a regular grid and obeys commands. Guarantee: the output is a function of
// the settings and of the model times of the commands, to the last bit. So a node can pace a run, and a checker can
// repeat it.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "afm/detail/sample_grid.h"
#include "bath.h"
#include "friction.h"
#include "level.h"
#include "model.h"
#include "saved_state.h"
#include "state.h"
#include "tip.h"

namespace afm {

struct EmulatorSettings {
  Model model;
  double eta = 3.4;  // drag velocity at start [a/tau], signed
  FreeState initial{0.25, 0.0, 0.2, 3.4, 0.0};
  double sample_period = 0.03;  // [tau]
  std::uint64_t samples_per_batch = 2000;
  double friction_window = 1000.0;      // [tau]
  std::uint64_t impact_budget = 20000;  // impacts per batch; a batch that spends it ends there
  double contact_tolerance = kDefaultContactTolerance;
  Bath bath;  // none
};

// Every fault, named as in EmulatorSettings; natural units.
std::vector<ParameterError> find_faults(const EmulatorSettings& settings);

// The settings that may change while running.
struct LiveSettings {
  double gamma, v_c, y0;  // of the model
  double sample_period;   // [tau]
  std::uint64_t samples_per_batch;
  double friction_window;  // [tau]
  Bath bath;
};
LiveSettings live_settings(const EmulatorSettings& settings);

// The result of one advance: the samples and impacts of [begin, end).
struct Batch {
  ModelTime begin, end;
  ModelTime first_sample_time;
  std::uint64_t first_sample = 0;  // running index
  std::vector<double> vertical;    // y - y0 [a]
  std::vector<double> lateral;     // x - xc [a]
  std::uint64_t first_impact = 0;  // running index
  std::vector<Impact> impacts;
  FrictionEstimate friction;  // at end
  double eta = 0.0;           // drag velocity throughout the batch
};

// Counters of trouble; they stay zero in a good run.
struct Counters {
  std::uint64_t budget_exhausted = 0;
  std::uint64_t search_failures = 0;
  double worst_penetration = 0.0;  // deepest sample taken below the surface [a]
};

class Emulator {
 public:
  explicit Emulator(const EmulatorSettings& settings);  // throws the first ParameterError

  void drag(double eta);  // from now() on. Precondition: finite and |eta| <= kMaxEta
  // From now() on. The state of the tip stays, and settings that stay the same have no effect. A new model or bath
  // restarts the friction estimate, a new window restarts its window. A new sample period takes its first sample at
  // now(). Precondition: settings() with these have no faults.
  void change(const LiveSettings& live);
  // Another level of the model from now() on (see Tip::set_model). The friction estimate restarts.
  // Returns the energy that is dropped [m a^2/tau^2]. Precondition: has_valid_tolerance(level).
  double set_level(const Level& level);
  // Whether samples are computed from now() on, or only counted. The motion is the same to the bit.
  void take_samples(bool wanted) { sampling_ = wanted; }
  // Back to the initial state and drag velocity at model time 0, with indices and counters 0. Other settings stay.
  void reset();

  // Each clears the batch and fills it. Guarantee: no allocation if the batch has room for samples_per_batch samples
  // and impact_budget impacts (see reserve).
  Outcome run_batch(Batch& batch);                         // to the next batch boundary of the sample grid
  Outcome run_until(const ModelTime& time, Batch& batch);  // precondition: at most one batch boundary ahead
  Outcome run_impacts(std::uint64_t n, Batch& batch);      // to the n-th next impact or the next batch boundary

  void reserve(Batch& batch) const;

  // The complete state. A restored emulator goes on with the same bits on every machine; its counters start at zero.
  // No allocation.
  void save(SavedState& out) const;
  static std::optional<Emulator> restored(const SavedState& state);  // empty: no emulator can be in that state

  ModelTime now() const { return now_; }
  double eta() const { return eta_; }
  FreeState state() const { return tip_.state(); }         // at now()
  std::uint64_t samples() const { return next_sample_; }   // number due so far
  const SampleGrid& grid() const { return grid_; }         // on which they are taken at present
  std::uint64_t impacts() const { return impact_index_; }  // so far
  ModelTime estimated_since() const { return friction_.start(); }
  const Thermostat& thermostat() const { return tip_.thermostat(); }  // of the kicks to come
  const Counters& counters() const { return counters_; }
  const EmulatorSettings& settings() const { return settings_; }

 private:
  friend class StateFields;

  ModelTime next_boundary() const;
  void begin(Batch& batch) const;
  Outcome run(const ModelTime& end, std::uint64_t impacts, Batch& batch);
  Outcome run_segments(const ModelTime& end, std::uint64_t impacts, Batch& batch);
  void sample_until(const ModelTime& time, Batch& batch);
  std::uint64_t first_sample_from(const ModelTime& time) const;

  EmulatorSettings settings_;
  double eta_;
  Tip tip_;
  Friction friction_;
  ModelTime now_;
  SampleGrid grid_;
  std::uint64_t next_sample_ = 0;
  bool sampling_ = true;
  std::uint64_t impact_index_ = 0;
  Counters counters_;
};

}  // namespace afm
