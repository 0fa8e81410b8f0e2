// The parameters of the node at start: read once, checked as a whole, const afterwards.
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <ros/node_handle.h>

#include "afm/run.h"
#include "afm/level_table.h"
#include "afm/units.h"
#include "live.h"

namespace afm::node {

constexpr char kRealTime[] = "real_time", kLockstep[] = "lockstep", kCommand[] = "command";

// Named as on the parameter server. The defaults are those of config/emulator.yaml.
struct Parameters {
  SiModel si;
  Lever lever;                                    // instead of frequencies and mass: what read_parameters sets them by
  double load_n = 0.0;                            // instead of si.rest_height_m [N]
  SiBath bath;
  std::string model = "oscillator";
  double tolerance = 0.0;                         // of model auto: error allowed, relative; 0: none given
  std::string tolerance_of = "friction";          // or deflection
  std::string level_table;                        // of model auto: file
  double drag_velocity = 1.1255437575458838e-05;  // at start and after a reset [m/s]: eta = 3.4
  double max_drag_velocity = 1e-4;                // faster commands are refused [m/s]: eta = 30.2
  FreeState initial{0.25, 0.0, 0.2, 3.4, 0.0};
  double time_scale = 1.0;                        // model time per wall time
  std::string pace = kRealTime;                   // or lockstep: the run advances when ~control or ~step asks for it
  std::string wait_for = "nothing";               // in lockstep, or command: a batch for every command
  double command_wait_s = 1.0;                    // of wall time, after which a batch goes on without its command
  bool publish_clock = false;                     // model time on /clock
  double batch_rate_hz = 100.0;                   // of wall time
  double sample_rate_hz = 200000.0;               // of model time
  double friction_window_tau = 1000.0;
  std::vector<double> commands_eta;               // drag velocities that the emulator plays, over and over [a/tau]
  double commands_hold_s = 0.1;                   // each for so long, of model time
  double command_timeout_s = 0.0;  // of wall time without a drag command, after which the drag stops; 0: never
  std::uint64_t impact_budget = 20000;            // a batch
  double contact_tolerance = kDefaultContactTolerance;  // [a, a/tau]
  bool paused = false;                            // at start: no model time passes until ~pause or ~step is called
  bool record = false;
  std::string bag_directory = "~/afm_bags";
  double disk_reserve_mb = 200.0;                 // left free on the disk that is recorded to
  std::string compression = "none";               // of bags: none or lz4
  double split_size_mb = 0.0;                     // a recording goes on in a new bag after so much; 0: never
  double split_duration_s = 0.0;                  // or after so long, of wall time; 0: never
  std::shared_ptr<const LevelTable> levels;       // what the file holds, if the model is auto
};

constexpr char kAuto[] = "auto";  // model: a level of it for every drag velocity

constexpr double kLeastFrictionWindow = 1.0, kMostFrictionWindow = 1e9;  // [tau]

// A fault of one parameter, with the name and value that were given.
struct Fault {
  std::string name, value, reason;
};
using Faults = std::vector<Fault>;

std::string describe(const Faults& faults);  // a line each: "name = value: reason"

// Reads the private parameters of `node`: the only place that asks the parameter server. Finds every fault there is.
Parameters load_parameters(const ros::NodeHandle& node, Faults& faults);

std::string expand_home(const std::string& path);  // a leading ~/

// The same from a tree of values, as a YAML file gives it.
Parameters read_parameters(XmlRpc::XmlRpcValue tree, Faults& faults);

// Of model auto: its table. Adds a fault if it cannot be read.
void load_levels(Parameters& parameters, Faults& faults);

// Faults of values that have the right types.
Faults find_faults(const Parameters& parameters);

// Sample rates that may be had at these rates of batches and of time [1/s].
double least_sample_rate(const Parameters& parameters);
double most_sample_rate(const Parameters& parameters);

// What follows from them. A batch holds whole samples, so its length gives way to the sample rate, not the other way.
std::uint64_t samples_per_batch(const Parameters& parameters);
std::chrono::nanoseconds batch_period(const Parameters& parameters);  // of wall time
RunSettings run_settings(const Parameters& parameters);
// Empty, with room for the largest there may be at any sample rate.
Batch preallocated_batch(const Parameters& parameters);

// The level that runs at a drag velocity [a/tau]: of auto the cheapest that its tolerance allows, and where the table
// has no data, or with a heat bath, the oscillator at contact_tolerance. Allocates nothing.
LevelChoice choose_level(const Parameters& parameters, const Model& model, double eta);
Level full_level(const Parameters& parameters);  // with which a run begins, before its first drag velocity is applied

// The one place that turns a drag velocity into natural units, as its bits decide those of a run.
double to_eta(double drag_velocity, const SiModel& si);

}  // namespace afm::node
