// One epoch of a run again, from its configuration and its commands, as far as it is asked to go. What it gives is in
// messages as the node would have published them, without stamps.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "afm/emulator.h"
#include "afm/units.h"
#include "node/wire/run_digest.h"
#include "run_log.h"

namespace afm::replay {

class Resimulation {
 public:
  explicit Resimulation(const EpochLog& log);

  // Emulates up to `time`, and of the impacts at `time` itself as many as make `impacts` in all; without a number, all.
  // Commands take effect at their times; one that took effect at the very end of this is left to the next call.
  void run_to(const ModelTime& time, std::optional<std::uint64_t> impacts);
  // Commands up to so many in all, as far as they take effect now.
  void apply_commands(std::uint64_t commands);

  ModelTime now() const { return emulator_.now(); }
  std::uint64_t samples() const { return first_sample_ + vertical_.size(); }
  std::uint64_t impacts() const { return first_impact_ + impacts_.size(); }
  std::optional<Applied> last_command() const;  // that the recording holds
  ModelTime sample_time(std::uint64_t sample) const { return log_.sample_time(sample); }
  std::uint64_t most_samples_per_batch() const { return log_.most_samples_per_batch(); }
  double batch_length() const;  // [tau]
  double time_unit() const { return units_.time(); }
  const EmulatorSettings& settings() const { return emulator_.settings(); }

  // What was emulated and is not forgotten; less than asked for where it was not.
  afm_emulator::Deflection deflection(std::uint64_t first, std::uint64_t count) const;
  afm_emulator::ImpactArray impacts(std::uint64_t first, std::uint64_t count) const;
  afm_emulator::Friction friction() const;  // at now()
  afm_emulator::Checkpoint checkpoint() const;
  void forget(std::uint64_t samples_before, std::uint64_t impacts_before);

  node::RunDigest& digest() { return digest_; }  // of all that was emulated; estimates are added by who asks for them

 private:
  bool is_due(const Applied& command, const ModelTime& time, std::optional<std::uint64_t> impacts) const;
  void apply_next_command();
  void apply(afm_emulator::AppliedDrag drag);
  void apply(const afm_emulator::AppliedParameters& change);
  template <class Message>
  node::AppliedLevel take_level(const Message& applied);
  void run_flights(const ModelTime& time, std::optional<std::uint64_t> impacts);
  void take(const Batch& batch);
  void drop_unwanted();
  void digest_samples(const afm_emulator::Deflection& batch);

  const EpochLog& log_;
  const Units units_;
  node::Parameters parameters_;  // as they are now
  Emulator emulator_;
  Batch batch_;
  std::size_t next_command_ = 0;
  std::uint64_t drags_ = 0;                              // of those commands
  double drag_velocity_;                                 // in force [m/s]
  std::uint64_t first_sample_ = 0, first_impact_ = 0;    // of those kept
  std::uint64_t wanted_sample_ = 0, wanted_impact_ = 0;  // of those before it none is kept
  std::vector<double> vertical_, lateral_;               // [m]
  std::vector<afm_emulator::Impact> impacts_;
  node::RunDigest digest_;
};

}  // namespace afm::replay
