// Is a recording sound by itself? Everything that can be checked without simulating the run again.
#pragma once

#include <afm_emulator/EmulatorStatus.h>

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "energy_audit.h"
#include "friction_audit.h"
#include "tools/replay/batches.h"
#include "tools/replay/recorded_digest.h"
#include "tools/replay/recording.h"
#include "tools/replay/run_log.h"

namespace afm::audit {

// A line of the report.
struct Finding {
  enum class Kind { good, bad, note };
  Kind kind;
  std::string subject, text;
};

class BagAudit {
 public:
  explicit BagAudit(const replay::Recording& recording);

  std::vector<Finding> run();  // throws replay::Problem
  const FrictionReport& friction() const { return friction_report_; }

 private:
  void begin_epoch(const replay::RecordedBatch& batch);
  void begin_where_known(const replay::EpochLog& log);
  void finish_epoch();
  void follow_commands(const replay::RecordedBatch& batch);
  void follow(const afm_emulator::AppliedDrag& drag);
  void follow(const afm_emulator::AppliedParameters& change);
  void follow_level(const Level& level, const ModelTime& time);
  void check_grid(const replay::RecordedBatch& batch);
  bool has_its_end(const replay::RecordedBatch& batch) const;
  bool has_ordered_impacts(const replay::RecordedBatch& batch) const;
  void count_impacts(const replay::RecordedBatch& batch);
  void add(const replay::RecordedBatch& batch);
  void check_status();

  void report_extent(std::vector<Finding>& findings) const;
  void report_sequence(std::vector<Finding>& findings) const;
  void report_digests(std::vector<Finding>& findings) const;
  void report_energy(std::vector<Finding>& findings) const;
  void report_balance(std::vector<Finding>& findings) const;
  void report_friction(std::vector<Finding>& findings) const;
  void report_counters(std::vector<Finding>& findings) const;

  const replay::Recording& recording_;
  const replay::RunLog log_;
  replay::Batches batches_;
  replay::RecordedDigest recorded_;
  std::unique_ptr<EnergyAudit> energy_;
  std::unique_ptr<FrictionAudit> friction_;
  std::optional<std::uint32_t> epoch_, last_batch_;
  std::size_t next_command_ = 0;
  node::Parameters parameters_;  // as they are now, like the next
  Thermostat kicks_;
  SampleGrid grid_;
  Level level_;
  std::uint64_t changes_ = 0;  // of parameters, beside those that every epoch begins with
  std::optional<std::uint64_t> next_sample_, next_impact_;
  ModelTime first_time_, last_time_;
  bool history_known_ = false;

  EnergyReport energy_report_;
  FrictionReport friction_report_;
  std::uint64_t samples_ = 0, impacts_ = 0, bounces_ = 0, epochs_ = 0, digests_ = 0;
  std::uint64_t grid_errors_ = 0, order_errors_ = 0, status_gaps_ = 0;
  double model_seconds_ = 0.0;
  ros::Time begin_stamp_, end_stamp_;
  std::optional<replay::FieldDifference> contradiction_;
  std::optional<afm_emulator::EmulatorStatus> status_;
};

}  // namespace afm::audit
