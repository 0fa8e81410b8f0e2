// The parameters of the node: read once, checked as a whole. table.h lists them by name.
#pragma once

#include <ros/node_handle.h>

#include <chrono>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "afm/level_table.h"
#include "afm/run.h"
#include "afm/units.h"

namespace afm::node {

constexpr char kRealTime[] = "real_time", kLockstep[] = "lockstep", kCommand[] = "command", kAuto[] = "auto";

constexpr double kMaxSampleRate = 1e6;       // [1/s] a choice: 25 samples a turn of the paper's horizontal spring
constexpr double kMaxWallSampleRate = 1e7;   // [1/s]: at time scales above 1, what subscribers can take
constexpr double kMaxSamplesPerBatch = 1e6;  // 16 MB a message

// The live parameters, and the constants of the model that stand in the same structs. Plain values, which travel
// through lock-free queues.
struct Live {
  SiModel si;
  SiBath bath;
  double drag_velocity = 1.1255437575458838e-05;  // [m/s], signed: eta = 3.4
  double sample_rate_hz = 200000.0;               // of model time
  double friction_window_tau = 1000.0;
};

// The defaults are those of config/emulator.yaml, which says what each parameter means.
struct Parameters : Live {
  Lever lever;                           // in place of two frequencies and the mass
  double load_n = 0.0;                   // in place of si.rest_height_m
  std::string lever_file, surface_file;  // from which the parameters have been loaded, to be checked
  std::string model = "oscillator";
  double tolerance = 0.0;
  std::string tolerance_of = "friction";
  std::string level_table;
  double max_drag_velocity = 1e-4;
  FreeState initial{0.25, 0.0, 0.2, 3.4, 0.0};
  double time_scale = 1.0;
  std::string pace = kRealTime;
  std::string wait_for = "nothing";
  double command_wait_s = 1.0;
  bool publish_clock = false;
  double batch_rate_hz = 100.0;
  std::vector<double> commands_eta;
  double commands_hold_s = 0.1;
  double command_timeout_s = 0.0;
  std::uint64_t impact_budget = 40000;
  double contact_tolerance = kDefaultContactTolerance;
  bool paused = false;
  bool record = false;
  std::string bag_directory = "~/afm_bags";
  double disk_reserve_mb = 200.0;
  std::string compression = "none";
  double split_size_mb = 0.0;
  double split_duration_s = 0.0;

  std::shared_ptr<const LevelTable> levels;  // with model auto: the content of the file level_table
};

inline Live& live_of(Parameters& parameters) { return parameters; }

// A fault of one parameter, with the name and value that were given.
struct Fault {
  std::string name, value, reason;
};
using Faults = std::vector<Fault>;

void add(const std::vector<ParameterError>& faults_of_core, Faults& faults);
std::string describe(const Faults& faults);  // a line each: "name = value: reason"

// Reads the private parameters of `node`: the only place that asks the parameter server. Finds every fault there is.
Parameters load_parameters(const ros::NodeHandle& node, Faults& faults);
// The same from a tree of values, as a YAML file gives it.
Parameters read_parameters(XmlRpc::XmlRpcValue tree, Faults& faults);

// Faults of values that have the right types.
Faults find_faults(const Parameters& parameters);

// Derived from them. A batch holds whole samples, so its length gives way to the sample rate, not the other way.
std::uint64_t samples_per_batch(const Parameters& parameters);
std::chrono::nanoseconds batch_period(const Parameters& parameters);  // of wall time
RunSettings run_settings(const Parameters& parameters);
// Empty, with room for the largest batch at any sample rate.
Batch preallocated_batch(const Parameters& parameters);

// The level that runs with these settings: with model auto the cheapest that its tolerance allows. Where the table has
// no data, or with a heat bath, the oscillator at contact_tolerance. Allocates nothing.
LevelChoice choose_level(const Parameters& parameters, const RunSettings& settings);

// The one place that turns a drag velocity into natural units, as its bits decide those of a run.
double to_eta(double drag_velocity, const SiModel& si);
// The largest that is at most kMaxEta in lattice spacings per tau [m/s].
double most_drag_velocity(const SiModel& si);

}  // namespace afm::node
